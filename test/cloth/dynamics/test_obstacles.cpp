#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "../../refusal.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/scene/scene.h"

namespace haptex::cloth::test_obstacles {
namespace {

namespace fs = std::filesystem;

const fs::path kConfig = HAPTEX_CONFIG_DIRECTORY;

const std::string kSurface = R"(# no texture coordinates
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vn 0 0 1
f 1 2 3
f 1//1 2//1 -1//1
)";

// A scene with the list of obstacles under test; scenes/, fabrics/ and meshes/ as under config/.
class ObstacleList : public testing::Test {
 protected:
  ObstacleList()
      : root_(fs::path(testing::TempDir()) / ("haptex_obstacles_" + std::to_string(getpid()))) {
    for (const char* kind : {"scenes", "fabrics", "meshes"}) fs::create_directories(root_ / kind);
    fs::copy_file(kConfig / "fabrics/linear.yaml", root_ / "fabrics/silk.yaml");
    std::ofstream(root_ / "meshes/corner.obj") << kSurface;
  }
  ~ObstacleList() override { fs::remove_all(root_); }

  std::string path() const { return (root_ / "scenes/scene.yaml").string(); }

  std::vector<mesh::Obstacle> load(const std::string& obstacles) const {
    std::ofstream(path()) << "fabric: silk\n"
                             "sheet: {size: [1, 1], cells: [1, 1], diagonals: one_way}\n"
                             "attach: []\nmodel: []\ntime_step: 0.01\n"
                          << obstacles;
    return scene::loadScene(path()).obstacles;
  }

  std::string refusalOf(const std::string& obstacles) const {
    return test::refusalOf([&] { load(obstacles); });
  }

  fs::path root_;
};

TEST_F(ObstacleList, MayBeMissingOrEmpty) {
  EXPECT_TRUE(load("").empty());
  EXPECT_TRUE(load("obstacles: []\n").empty());
}

TEST_F(ObstacleList, ReadsEveryShape) {
  const auto obstacles = load(R"(obstacles:
  - {name: table, box: [0.1, 0.2, 0.3], position: [1, 2, 3]}
  - {name: ball, sphere: 0.05, position: [0, 0, 0]}
  - {name: post, capsule: {radius: 0.01, length: 0.2}, position: [0, 0, 0]}
  - {name: shelf, mesh: corner, position: [0, 0, 0]}
)");
  ASSERT_EQ(obstacles.size(), 4u);
  EXPECT_EQ(obstacles[0].name, "table");
  EXPECT_EQ(std::get<mesh::ObstacleBox>(obstacles[0].shape).sides, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(obstacles[0].pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(obstacles[0].pose.linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(obstacles[1].name, "ball");
  EXPECT_EQ(std::get<mesh::ObstacleSphere>(obstacles[1].shape).radius, 0.05);
  EXPECT_EQ(obstacles[2].name, "post");
  EXPECT_EQ(std::get<mesh::ObstacleCapsule>(obstacles[2].shape).radius, 0.01);
  EXPECT_EQ(std::get<mesh::ObstacleCapsule>(obstacles[2].shape).length, 0.2);
  EXPECT_EQ(obstacles[3].name, "shelf");
  const auto& mesh = std::get<mesh::ObstacleMesh>(obstacles[3].shape);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 1, 3}}));
}

// A quarter turn about each axis of its own has a matrix that can be written down; the order shows
// where all three differ: x is turned first, about the fixed axes.
TEST_F(ObstacleList, TurnsByRollPitchAndYawAboutTheFixedAxes) {
  const auto rotation = [&](const std::string& rpy) -> Eigen::Matrix3d {
    return load("obstacles: [{name: a, sphere: 1, position: [0, 0, 0], rpy: " + rpy + "}]\n")[0]
        .pose.linear();
  };
  const std::string quarter = "1.5707963267948966";
  Eigen::Matrix3d roll, pitch, yaw;
  roll << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  pitch << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  yaw << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_TRUE(rotation("[" + quarter + ", 0, 0]").isApprox(roll, 1e-15));
  EXPECT_TRUE(rotation("[0, " + quarter + ", 0]").isApprox(pitch, 1e-15));
  EXPECT_TRUE(rotation("[0, 0, " + quarter + "]").isApprox(yaw, 1e-15));
  // (1, 0, 0) -roll-> (1, 0, 0) -yaw-> (0, 1, 0); (0, 1, 0) -roll-> (0, 0, 1) -yaw-> (0, 0, 1)
  const Eigen::Matrix3d both = rotation("[" + quarter + ", 0, " + quarter + "]");
  EXPECT_TRUE(both.col(0).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE(both.col(1).isApprox(Eigen::Vector3d::UnitZ(), 1e-15));
  const Eigen::Matrix3d all = rotation("[" + quarter + ", " + quarter + ", " + quarter + "]");
  EXPECT_TRUE(all.isApprox(yaw * pitch * roll, 1e-15));
}

TEST_F(ObstacleList, MoveAsTheySay) {
  const auto obstacles = load(
      "obstacles:\n"
      "  - {name: a, sphere: 1, position: [2, 0, 0],\n"
      "     orbit: {centre: [1, 0, 5], axis: [0, 0, 3], period: 4}}\n"
      "  - {name: b, sphere: 1, position: [2, 0, 0], velocity: [0, 3, 0], friction: 0.4}\n"
      "  - {name: c, sphere: 1, position: [2, 0, 0]}\n");
  // A quarter of a turn to the right hand of the axis, after one and after five seconds.
  for (const double time : {1.0, 5.0}) {
    const Eigen::Isometry3d pose = obstacles[0].poseAt(time);
    EXPECT_LT((pose.translation() - Eigen::Vector3d(1, 1, 0)).norm(), 1e-15);
    EXPECT_LT((pose.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  }
  EXPECT_EQ(obstacles[1].poseAt(2.0).translation(), Eigen::Vector3d(2, 6, 0));
  EXPECT_EQ(obstacles[1].friction, 0.4);
  EXPECT_EQ(obstacles[2].poseAt(2.0).translation(), Eigen::Vector3d(2, 0, 0));
  EXPECT_FALSE(obstacles[2].friction);
  EXPECT_TRUE(obstacles[0].moves() && obstacles[1].moves() && !obstacles[2].moves());
}

TEST_F(ObstacleList, RefusesMotionsNamingTheKey) {
  const auto refusal = [&](const std::string& keys) {
    return refusalOf("obstacles: [{name: a, sphere: 1, position: [2, 0, 0], " + keys + "}]\n");
  };
  const auto expect = [](const std::string& found, const std::string& part) {
    EXPECT_NE(found.find(part), std::string::npos) << found;
  };
  expect(refusal("orbit: {centre: [0, 0, 0], axis: [0, 0, 0], period: 1}"),
         "axis: must not be zero");
  expect(refusal("orbit: {centre: [0, 0, 0], axis: [0, 0, 1], period: 0}"),
         "period: '0' must be at least 1e-3 s");
  expect(refusal("orbit: {centre: [0, 0, 0], axis: [0, 0, 1]}"), "'period' is missing");
  expect(refusal("velocity: [0, 0, 1001]"), "must be from -1000 to 1000 m/s");
  expect(refusal("friction: -0.1"), "must be >= 0");
  expect(refusal("velocity: [0, 0, 1], orbit: {centre: [0, 0, 0], axis: [0, 0, 1], period: 1}"),
         "at most one of orbit, velocity");
}

TEST_F(ObstacleList, MustNotBeEmptyIfTheModelListsObstacles) {
  std::ofstream(path()) << "fabric: silk\n"
                           "sheet: {size: [1, 1], cells: [1, 1], diagonals: one_way}\n"
                           "attach: []\nmodel: [obstacles]\ntime_step: 0.01\nobstacles: []\n";
  try {
    scene::loadScene(path());
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("must have at least one"), std::string::npos)
        << error.what();
  }
}

TEST_F(ObstacleList, FindsMeshesByPath) {
  for (const std::string& name : {std::string("corner.obj"), std::string("../meshes/corner.obj"),
                                  (root_ / "meshes/corner.obj").string()}) {
    const auto obstacles =
        load("obstacles: [{name: a, mesh: " + name + ", position: [0, 0, 0]}]\n");
    EXPECT_EQ(std::get<mesh::ObstacleMesh>(obstacles[0].shape).triangles.size(), 2u) << name;
  }
}

TEST_F(ObstacleList, NamesTheMeshesThereAre) {
  const std::string meshes = (root_ / "meshes").string();
  EXPECT_EQ(refusalOf("obstacles: [{name: a, mesh: shelf, position: [0, 0, 0]}]\n"),
            path() + ": obstacles[0].mesh: 'shelf' must be a name in " + meshes +
                " (corner) or a path with a '/'; there is no file " + meshes + "/shelf.obj");
}

TEST_F(ObstacleList, NamesTheMeshThatIsTooFarAway) {
  const std::string mesh = (root_ / "meshes/far.obj").string();
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 -100.5\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(refusalOf("obstacles: [{name: a, mesh: far, position: [0, 0, 0]}]\n"),
            path() + ": obstacles[0].mesh: position 2 of " + mesh +
                " must be from -100 to 100 m along every axis");
}

TEST_F(ObstacleList, NamesTheMeshAndItsLine) {
  std::ofstream(root_ / "meshes/quad.obj") << "f 1 2 3 4\n";
  EXPECT_EQ(
      refusalOf("obstacles: [{name: a, mesh: quad, position: [0, 0, 0]}]\n"),
      (root_ / "meshes/quad.obj").string() + ": line 1: a face has 4 corners, must be a triangle");
}

TEST_F(ObstacleList, AcceptsValuesAtTheirLimits) {
  EXPECT_NO_THROW(load("obstacles: [{name: a, sphere: 100, position: [100, -100, 0]}]\n"));
}

TEST_F(ObstacleList, RefusesANameGivenTwice) {
  EXPECT_EQ(refusalOf("obstacles:\n  - {name: a, sphere: 1, position: [0, 0, 0]}\n"
                      "  - {name: a, sphere: 1, position: [0, 0, 0]}\n"),
            path() + ": obstacles[1].name: 'a' is the name of an earlier obstacle, must be unique");
}

struct Refusal {
  std::string name;
  std::string obstacle;
  std::string complaint;  // after path and index
};

void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

class ObstacleListRefuses : public ObstacleList, public testing::WithParamInterface<Refusal> {};

TEST_P(ObstacleListRefuses, NamingFileKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(refusalOf("obstacles: [{" + GetParam().obstacle + "}]\n"),
            path() + ": obstacles[0]" + GetParam().complaint);
}

const std::string kAtOrigin = ", position: [0, 0, 0]";

INSTANTIATE_TEST_SUITE_P(
    Values, ObstacleListRefuses,
    testing::Values(
        Refusal{"NoName", "sphere: 1" + kAtOrigin,
                ": the key 'name' is missing, required here: name, position"},
        Refusal{"BlankName", "name: ' ', sphere: 1" + kAtOrigin,
                ".name: ' ' must be a text that is not empty"},
        Refusal{"NoPosition", "name: a, sphere: 1",
                ": the key 'position' is missing, required here: name, position"},
        Refusal{"UnknownKey", "name: a, cone: 1" + kAtOrigin,
                ".cone: unknown key, allowed here: name, position, sphere, box, capsule, mesh, "
                "rpy, orbit, velocity, friction, body"},
        Refusal{"NoShape", "name: a" + kAtOrigin,
                ": must have exactly one of sphere, box, capsule, mesh"},
        Refusal{"TwoShapes", "name: a, sphere: 1, box: [1, 1, 1]" + kAtOrigin,
                ": must have exactly one of sphere, box, capsule, mesh"},
        Refusal{"ZeroRadius", "name: a, sphere: 0" + kAtOrigin,
                ".sphere: '0' must be > 0 and <= 100 m"},
        Refusal{"RadiusTooLarge", "name: a, sphere: 100.5" + kAtOrigin,
                ".sphere: '100.5' must be > 0 and <= 100 m"},
        Refusal{"RadiusNan", "name: a, sphere: .nan" + kAtOrigin,
                ".sphere: '.nan' must be a finite number"},
        Refusal{"FlatBox", "name: a, box: [1, 1, 0]" + kAtOrigin,
                ".box[2]: '0' must be > 0 and <= 100 m"},
        Refusal{"BoxOfTwoSides", "name: a, box: [1, 1]" + kAtOrigin,
                ".box: a list of 2 must be a list of 3"},
        Refusal{"CapsuleWithoutLength", "name: a, capsule: {radius: 1}" + kAtOrigin,
                ".capsule: the key 'length' is missing, required here: radius, length"},
        Refusal{"CapsuleOfNegativeLength", "name: a, capsule: {radius: 1, length: -1}" + kAtOrigin,
                ".capsule.length: '-1' must be > 0 and <= 100 m"},
        Refusal{"PositionTooFarAway", "name: a, sphere: 1, position: [0, 0, -100.5]",
                ".position[2]: '-100.5' must be from -100 to 100 m"},
        Refusal{"PositionInfinite", "name: a, sphere: 1, position: [0, .inf, 0]",
                ".position[1]: '.inf' must be a finite number"},
        Refusal{"PositionNotAVector", "name: a, sphere: 1, position: 3",
                ".position: '3' must be a list of 3"},
        Refusal{"RpyNotANumber", "name: a, sphere: 1, rpy: [0, left, 0]" + kAtOrigin,
                ".rpy[1]: 'left' must be a finite number"}),
    [](const auto& info) { return info.param.name; });

TEST_F(ObstacleList, MustBeAList) {
  EXPECT_EQ(refusalOf("obstacles: 3\n"), path() + ": obstacles: '3' must be a list");
  EXPECT_EQ(refusalOf("obstacles: [ball]\n"),
            path() +
                ": obstacles[0]: 'ball' must be a map with the keys name, position, sphere, "
                "box, capsule, mesh, rpy, orbit, velocity, friction, body");
}

// What is wrong in an OBJ file of a surface.
TEST_F(ObstacleList, NamesFileAndLineOfABadSurface) {
  const std::string mesh = (root_ / "meshes/bad.obj").string();
  const auto refusal = [&](const std::string& text) {
    std::ofstream(mesh) << text;
    return refusalOf("obstacles: [{name: a, mesh: bad, position: [0, 0, 0]}]\n");
  };
  EXPECT_EQ(refusal("v 0 0 0\n"), mesh + ": the mesh has no triangle");
  EXPECT_EQ(refusal(kSurface + "f 1 2 3 4\n"),
            mesh + ": line 9: a face has 4 corners, must be a triangle");
  EXPECT_EQ(refusal(kSurface + "f 1 2 5\n"),
            mesh + ": line 9: position 5 does not exist, 4 are defined before this line");
  EXPECT_EQ(refusal(kSurface + "f 1 2 b/1\n"),
            mesh + ": line 9: position of a corner must be a whole number");
  EXPECT_EQ(refusal(kSurface + "v 1 2 up\n"),
            mesh + ": line 9: number 3 of 'v' must be a finite number");
}

TEST_F(ObstacleList, NamesTheSurfaceThatCannotBeRead) {
  const std::string missing = (root_ / "meshes/none.obj").string();
  try {
    mesh::loadObjSurface(missing);
    ADD_FAILURE() << "was read";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), missing + ": cannot be read, must be a Wavefront OBJ file");
  }
}

TEST(ShippedScenes, WoolAmongObstaclesHasOneOfEachKind) {
  const scene::Scene scene =
      scene::loadScene((kConfig / "scenes/wool_among_obstacles.yaml").string());
  ASSERT_EQ(scene.obstacles.size(), 4u);
  EXPECT_TRUE(std::holds_alternative<mesh::ObstacleBox>(scene.obstacles[0].shape));
  EXPECT_TRUE(std::holds_alternative<mesh::ObstacleSphere>(scene.obstacles[1].shape));
  EXPECT_TRUE(std::holds_alternative<mesh::ObstacleCapsule>(scene.obstacles[2].shape));
  EXPECT_TRUE(std::holds_alternative<mesh::ObstacleMesh>(scene.obstacles[3].shape));
  for (const char* name :
       {"acrylic_knit_sample", "cotton_knit_sample", "linear_sheet", "wool_sample"}) {
    const fs::path path = kConfig / "scenes" / (std::string(name) + ".yaml");
    EXPECT_TRUE(scene::loadScene(path.string()).obstacles.empty()) << name;
  }
}

}  // namespace
}  // namespace haptex::cloth::test_obstacles
