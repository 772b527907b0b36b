#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "haptex/base/workload.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::mesh::test_obj_file {
namespace {

class TemporaryObj {
 public:
  explicit TemporaryObj(const std::string& text)
      : path_(testing::TempDir() + "haptex_test_" + std::to_string(getpid()) + ".obj") {
    std::ofstream(path_) << text;
  }
  ~TemporaryObj() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A square of two triangles, one millimetre to the side of its rest shape.
const std::string kPoints = R"(# a square
mtllib none.mtl
o square
v 0.001 0 0
v 0.001 0.1 0 1.0
v 0.001 0.1 0.2
v 0.001 0 0.2
vt 0 0
vt 0.1 0
vt 0.1 0.2 0
vt 0 0.2
vn 1 0 0
s off
)";
const std::string kFaces = "f 1/1 2/2 3/3\nf 1/1/1 3/3/1 4/4/1\n";

void expectSquare(const ClothMesh& mesh) {
  ASSERT_EQ(mesh.initial_positions.size(), 4u);
  ASSERT_EQ(mesh.rest_coordinates.size(), 4u);
  EXPECT_EQ(mesh.initial_positions[2], Eigen::Vector3d(0.001, 0.1, 0.2));
  EXPECT_EQ(mesh.rest_coordinates[2], Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(mesh.rest_coordinates[3], Eigen::Vector2d(0.0, 0.2));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<int, 3>{0, 2, 3}));
}

TEST(ObjFile, ReadsPositionsRestCoordinatesAndTriangles) {
  expectSquare(loadObj(TemporaryObj(kPoints + kFaces).path()));
}

TEST(ObjFile, CountsNegativeIndicesBackwards) {
  expectSquare(loadObj(TemporaryObj(kPoints + "f -4/-4 -3/-3 -2/-2\nf -4/1 3/-2 -1/-1\n").path()));
}

TEST(ObjFile, ReadsWindowsLineEndsAndCommentsBehindStatements) {
  std::string text;
  for (const char c : kPoints + kFaces) text += c == '\n' ? " # note\r\n" : std::string(1, c);
  expectSquare(loadObj(TemporaryObj(text).path()));
}

TEST(ObjFile, AcceptsTextureCoordinatesRepeatedWithEqualValues) {
  const std::string repeated = "vt 0.1 0.2\nf 1/1 2/2 3/3\nf 1/1 3/5 4/4\n";
  expectSquare(loadObj(TemporaryObj(kPoints + repeated).path()));
}

/// The refusal without the path.
std::string refusalOf(const TemporaryObj& file) {
  try {
    loadObj(file.path());
  } catch (const std::exception& error) {
    return std::string(error.what()).substr(file.path().size());
  }
  return "accepted";
}

TEST(ObjFile, OfTooManyTrianglesIsRefusedAtTheFirstTooMany) {
  std::string text = kPoints;
  for (std::size_t i = 0; i < 2'100'000; ++i) text += "f 1/1 2/2 3/3\n";
  // Twelve lines come before the first.
  EXPECT_EQ(refusalOf(TemporaryObj(text)), ": line 2000014: more than 2000000 triangles");
}

TEST(ObjFile, OfTooManyPositionsOrTextureCoordinatesIsRefusedAtTheFirstTooMany) {
  if (base::kSanitized) GTEST_SKIP() << "reading 12 million lines takes minutes with sanitizers";
  std::string positions, textures;
  for (std::size_t i = 0; i <= 3 * kMostTriangles; ++i) {
    positions += "v 0 0 0\n";
    textures += "vt 0 0\n";
  }
  EXPECT_EQ(refusalOf(TemporaryObj(positions)), ": line 6000001: more than 6000000 positions");
  EXPECT_EQ(refusalOf(TemporaryObj(textures)),
            ": line 6000001: more than 6000000 texture coordinates");
}

TEST(ObjFile, TooLargeIsRefusedUnread) {
  const TemporaryObj file("");
  ASSERT_EQ(truncate(file.path().c_str(), 1'000'000'000), 0);  // takes no room on the disk
  EXPECT_EQ(refusalOf(file), ": has 1000000000 bytes: allowed are up to 268435456");
}

TEST(ObjFile, RefusalsRepeatNothingOfTheFile) {
  for (const std::string text : {"v secret 0 0\n", "vt 0 secret\n", "f secret/1 2/2 3/3\n",
                                 "f 1/secret 2/2 3/3\n", "f secret\n"}) {
    const std::string refusal = refusalOf(TemporaryObj(kPoints + text));
    EXPECT_NE(refusal, "accepted");
    EXPECT_EQ(refusal.find("secret"), std::string::npos) << refusal;
  }
}

struct Refusal {
  std::string name;
  std::string after_points;  // lines from 14 on
  std::string complaint;     // after the path
};

void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class ObjFileRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(ObjFileRefuses, NamingFileLineAndWhatIsWrong) {
  const TemporaryObj file(kPoints + GetParam().after_points);
  try {
    loadObj(file.path());
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), file.path() + ": " + GetParam().complaint);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Statements, ObjFileRefuses,
    testing::Values(
        Refusal{"Quad", "f 1/1 2/2 3/3 4/4\n", "line 14: a face has 4 corners, must be a triangle"},
        Refusal{"Edge", "f 1/1 2/2\n", "line 14: a face has 2 corners, must be a triangle"},
        Refusal{"SeamWithoutPanels", "vt 0.5 0.2\ng one\nf 1/1 2/2 3/3\ng\nf 1/1 3/5 4/4\n",
                "line 18: a face is in 0 groups ('g'): position 3 has the texture coordinates 3 "
                "and 5 (a seam), so every face must be in one group, its panel"},
        Refusal{"FaceOfTwoPanels", "vt 0.5 0.2\ng one two\nf 1/1 2/2 3/3\ng two\nf 1/1 3/5 4/4\n",
                "line 16: a face is in 2 groups ('g'): position 3 has the texture coordinates 3 "
                "and 5 (a seam), so every face must be in one group, its panel"},
        Refusal{"PositionAlone", "f 1 2 3\n",
                "line 14: a corner has no texture coordinate, which is its rest coordinate"},
        Refusal{"PositionAndNormal", "f 1//1 2//1 3//1\n",
                "line 14: a corner has no texture coordinate, which is its rest coordinate"},
        Refusal{"EmptyTexture", "f 1/ 2/2 3/3\n",
                "line 14: a corner has no texture coordinate, which is its rest coordinate"},
        Refusal{"PositionIndexTooLarge", "f 1/1 2/2 5/3\n",
                "line 14: position 5 does not exist, 4 are defined before this line"},
        Refusal{"PositionIndexZero", "f 0/1 2/2 3/3\n",
                "line 14: position 0 does not exist, 4 are defined before this line"},
        Refusal{"PositionIndexTooFarBack", "f 1/1 2/2 -5/3\n",
                "line 14: position -5 does not exist, 4 are defined before this line"},
        Refusal{"TextureIndexTooLarge", "f 1/1 2/2 3/7\n",
                "line 14: texture coordinate 7 does not exist, 4 are defined before this line"},
        Refusal{"IndexBeyondIntegers", "f 1/1 2/2 99999999999/3\n",
                "line 14: position of a corner must be a whole number"},
        Refusal{"IndexNotANumber", "f 1/1 b/2 3/3\n",
                "line 14: position of a corner must be a whole number"},
        Refusal{"PositionNotANumber", "v 1 2 up\n",
                "line 14: number 3 of 'v' must be a finite number"},
        Refusal{"PositionNan", "v 1 nan 3\n", "line 14: number 2 of 'v' must be a finite number"},
        Refusal{"TextureInfinite", "vt 1 inf\n",
                "line 14: number 2 of 'vt' must be a finite number"},
        Refusal{"NumberWithRest", "vt 1 2m\n", "line 14: number 2 of 'vt' must be a finite number"},
        Refusal{"TwoNumbers", "v 1 2\n", "line 14: 'v' has 2 numbers, must have 3"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Meshes, ObjFileRefuses,
    testing::Values(
        Refusal{"NoFaces", "",
                "the mesh has no triangle; particles in no triangle: 0 1 2 3 (counted from 0)"},
        Refusal{"RepeatedParticle", kFaces + "f 1/1 2/2 2/2\n",
                "degenerate triangles: 2 (counted from 0)"},
        Refusal{"RestCoordinatesInALine", kFaces + "v 0 0 1\nvt 0.2 0.4\nf 1/1 3/3 5/5\n",
                "degenerate triangles: 2 (counted from 0)"},
        Refusal{"SameTriangleTwice", kFaces + "f 2/2 3/3 1/1\n",
                "duplicate triangles: 2 (counted from 0)"},
        Refusal{"PositionInNoFace", "f 1/1 2/2 3/3\n",
                "particles in no triangle: 3 (counted from 0)"}),
    [](const auto& info) { return info.param.name; });

TEST(ObjFile, GivesTheTrianglesOfEveryGroup) {
  const TemporaryObj file(kPoints + "g empty\ng hem sewn\nf 1/1 2/2 3/3\ng hem hem\n" +
                          "f 1/1/1 3/3/1 4/4/1\n");
  MeshGroups groups;
  expectSquare(loadObj(file.path(), groups));
  EXPECT_EQ(groups, (MeshGroups{{"hem", {0, 1}}, {"sewn", {0}}}));
  const TemporaryObj closed(kPoints + "g hem\nf 1/1 2/2 3/3\ng\nf 1/1 3/3 4/4\n");
  loadObj(closed.path(), groups);
  EXPECT_EQ(groups, (MeshGroups{{"hem", {0}}}));
}

TEST(ObjFile, NamesTheFileThatCannotBeRead) {
  const std::string missing = testing::TempDir() + "haptex_there_is_no_such.obj";
  for (const std::string& path : {missing, testing::TempDir()}) {
    try {
      loadObj(path);
      ADD_FAILURE() << path << " was read";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), path + ": cannot be read, must be a Wavefront OBJ file");
    }
  }
}

}  // namespace
}  // namespace haptex::mesh::test_obj_file
