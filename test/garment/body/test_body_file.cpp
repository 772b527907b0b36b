#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "../../refusal.h"
#include "body_fixtures.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/body/makehuman.h"
#include "malformed_text.h"

namespace haptex::garment::test_body_file {
namespace {

const auto refusalOf = [](const auto& call) { return test::refusalOf<std::exception>(call); };

namespace fs = std::filesystem;

// A tetrahedron on whose vertices all joints lie.
const std::string kObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng joint\nf 1 2 3\ng body\nf 1/1 3/1 2/1\nf 1 2 4\n"
    "f 2 3 4\nf 3 1 4\n";
const std::string kTarget = "# a change\n0 .1 0 -0.2\n3 0 1 0\n";

std::string skeletonText() {
  std::ostringstream out;
  out << R"({"joints": {"low": [0, 1, 2], "high": [3]}, "bones": {)";
  std::string before;
  const auto bone = [&](const std::string& name, const std::string& parent) {
    out << before << '"' << name << R"(": {"head": "low", "tail": "high", "parent": )"
        << (parent.empty() ? "null" : '"' + parent + '"') << '}';
    before = ", ";
  };
  bone("root", "");
  for (const char* name : {"neck01", "head"}) bone(name, "root");
  for (const std::string side : {".L", ".R"}) {
    for (const char* name : {"upperarm01", "lowerarm01", "wrist", "finger3-3", "upperleg01",
                             "lowerleg01", "foot", "toe2-3"}) {
      bone(name + side, "root");
    }
  }
  out << "}}";
  return out.str();
}

const std::string kWeights =
    R"({"weights": {"root": [[0, 1], [1, 1.0], [2, 0.5]], "finger3-3.L": [[2, 0.25], [3, 1]]}})";

const std::string kSurface = R"(surface: prism.obj
segments:
  - {name: lower, start: [0, 0, 0], end: [0, 0, 0.5], radius: 0.1}
  - {name: upper, start: [0, 0, 0.5], end: [0, 0, 1], group: top, parent: lower, chain: up, within: lower}
pose: {upper: [0, 0, 0.5]}
)";

Figure smallFigure(const std::string& obj, const std::string& skeleton,
                   const std::string& weights) {
  FigureMesh mesh = parseFigure(obj, "small.obj");
  const std::size_t vertices = mesh.positions.size();
  return makeFigure(std::move(mesh), parseSkeleton(skeleton, "small.mhskel", vertices), weights,
                    "small.mhw");
}

class BodyFile : public testing::Test {
 protected:
  BodyFile() : directory_(fs::temp_directory_path() / ("haptex_body_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
    const Body prism = makePrism(0.1, 1.0, 6);
    std::ofstream obj(directory_ / "prism.obj");
    for (const auto& vertex : prism.vertices) obj << "v " << vertex.transpose() << '\n';
    for (std::size_t i = 0; i < prism.triangles.size(); ++i) {
      const auto& [a, b, c] = prism.triangles[i];
      obj << "g " << (i % 4 == 1 ? "top" : "rest") << "\nf " << a + 1 << ' ' << b + 1 << ' '
          << c + 1 << '\n';
    }
  }
  ~BodyFile() override { fs::remove_all(directory_); }

  Body parse(const std::string& text) const {
    return parseBody(text, directory_.string(), "small.yaml");
  }

  fs::path directory_;
};

TEST_F(BodyFile, SurfaceIsSharedOutByGroupsAndRadii) {
  const Body body = parse(kSurface);
  ASSERT_EQ(body.segments.size(), 2u);
  EXPECT_EQ(body.segments[1].parent, 0);
  EXPECT_EQ(body.segments[1].chain, "up");
  EXPECT_EQ(body.segments[1].within, "lower");
  EXPECT_EQ(body.segments[0].chain, "lower");
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    EXPECT_EQ(body.shares[i].front().segment, body.vertices[i].z() > 0.5 ? 1 : 0) << i;
  }
  // The upper end is turned about the axis, the lower one is not.
  EXPECT_NEAR(
      (body.vertices[3] - Eigen::Vector3d(0.1 * std::cos(0.5), 0.1 * std::sin(0.5), 1)).norm(), 0.0,
      1e-6);
  EXPECT_NEAR((body.vertices[2] - Eigen::Vector3d(0.1, 0, 0)).norm(), 0.0, 1e-6);
}

TEST_F(BodyFile, RefusalsNameKeyValueAndWhatIsAllowed) {
  const std::vector<std::tuple<std::string, std::string, std::string>> refused = {
      {"surface:", "surfaces:", "small.yaml: "},
      {"parent: lower", "parent: middle",
       "segments[1].parent: 'middle' must be an earlier segment"},
      {"name: upper", "name: lower", "segments[1].name: 'lower' is there twice: names must differ"},
      {"within: lower", "within: nothing",
       "segments[1].within: 'nothing' must be the chain of other segments"},
      {"within: lower", "within: up",
       "segments[1].within: 'up' must be the chain of other segments"},
      {"group: top", "group: bottom", "segments[1].group: 'bottom' is no group of"},
      {"radius: 0.1", "radius: -0.1", "segments[0].radius: '-0.1' must be > 0 m"},
      {", radius: 0.1", "", "segments[0]: must have one of radius, group"},
      {"end: [0, 0, 0.5]", "end: [0, 0, 0]",
       "segments[0]: start and end must be 1 mm or more apart"},
      {"end: [0, 0, 0.5]", "end: [0, 0, 500]", "must be within 100"},
      {"upper: [0, 0, 0.5]", "tail: [0, 0, 0.5]", "pose"},
      {"prism.obj", "none.obj", "none.obj"},
  };
  for (const auto& [part, other, message] : refused) {
    std::string text = kSurface;
    text.replace(text.find(part), part.size(), other);
    const std::string refusal = refusalOf([&] { parse(text); });
    EXPECT_NE(refusal.find(message), std::string::npos) << part << ": " << refusal;
  }
  std::ofstream(directory_ / "far.obj") << "v 0 0 0\nv 1 0 0\nv 0 1e9 0\nf 1 2 3\n";
  const std::string far =
      refusalOf([&] { parse("surface: far.obj" + kSurface.substr(kSurface.find('\n'))); });
  EXPECT_NE(far.find("far.obj: has a vertex at"), std::string::npos) << far;
  EXPECT_NE(
      refusalOf([&] { parse("makehuman: nowhere\nshape: female\n"); }).find("nowhere/base.obj"),
      std::string::npos);
  EXPECT_NE(refusalOf([&] {
              parse("makehuman: .\nshape: female\nmeasurements: {tail: 1}\n");
            }).find("tail"),
            std::string::npos);
}

TEST(MakeHumanFiles, AreReadWithTheWorldsAxesAndMetres) {
  const Figure figure = smallFigure(kObj, skeletonText(), kWeights);
  EXPECT_EQ(figure.mesh.triangles.size(), 4u);
  EXPECT_EQ(figure.mesh.positions[1], Eigen::Vector3d(0, 0.1, 0));  // x to the left
  EXPECT_EQ(figure.mesh.positions[3], Eigen::Vector3d(0.1, 0, 0));  // z forward
  ASSERT_EQ(figure.segments.size(), 15u);
  // A weight of a bone that makes no segment goes to that it hangs on, and sums are made 1.
  ASSERT_EQ(figure.shares[2].size(), 1u);
  EXPECT_EQ(figure.shares[2].front().weight, 1.0);
  const Target target = parseTarget(kTarget, "small.target", 4);
  ASSERT_EQ(target.steps.size(), 2u);
  EXPECT_NEAR((target.steps[0].by - Eigen::Vector3d(-0.02, 0.01, 0)).norm(), 0.0, 1e-17);
  const Body body = bodyOf(figure, figure.mesh.positions, 2.0);
  EXPECT_NEAR((body.segments[1].end - Eigen::Vector3d(0, 0.2, 0.2) / 3).norm(), 0.0, 1e-16);
  EXPECT_EQ(body.segments[2].end, Eigen::Vector3d(0.2, 0, 0));
  EXPECT_TRUE(isClosed(body.triangles));
  EXPECT_NEAR(volumeOf(body), 8e-3 / 6.0, 1e-15);
}

TEST(MakeHumanFiles, RefusalsNameTheLineAndWhatIsAllowed) {
  const auto target = [](const std::string& text) {
    return refusalOf([&] { parseTarget(text, "t", 4); });
  };
  EXPECT_EQ(target("0 1 2\n"), "t: line 1: must have 4 words");
  EXPECT_EQ(target("#\n4 0 0 0\n"), "t: line 2: vertices must be whole numbers from 0 to 3");
  EXPECT_EQ(target("1 nan 0 0\n"), "t: line 1: coordinate 1 must be a number from -100 to 100");
  EXPECT_EQ(refusalOf([] { parseFigure("v 0 0 0\ng body\nf 1 2 3\n", "f"); }),
            "f: line 3: vertices must be whole numbers from 1 to 1");
  EXPECT_EQ(refusalOf([] { parseFigure("v 0 0 0\n", "f"); }),
            "f: must have faces in a group 'body'");
  EXPECT_EQ(refusalOf([] { parseSkeleton("[]", "s", 4); }), "s: must be a JSON object");
  EXPECT_EQ(
      refusalOf([] { smallFigure(kObj, skeletonText(), R"({"weights": {"root": [[9, 1]]}})"); }),
      "small.mhw: weights of 'root': vertex 9 must be one of 0 to 3");
  EXPECT_EQ(
      refusalOf([] { smallFigure(kObj, skeletonText(), R"({"weights": {"root": [[0, 2]]}})"); }),
      "small.mhw: weights of 'root': 2 must be from 0 to 1");
  EXPECT_EQ(refusalOf([] { smallFigure(kObj, skeletonText(), R"({"weights": {}})"); }),
            "small.mhw: vertex 0 of the body has no weight");
}

void expectReadOrRefused(const std::string& text,
                         const std::function<void(const std::string&)>& read) {
  int refused = 0;
  for (int seed = 0; seed < 200; ++seed) {
    const std::string malformed = malformedText(text, 5000 + seed);
    const std::string refusal = refusalOf([&] { read(malformed); });
    if (refusal == test::kNotRefused) continue;
    EXPECT_GT(refusal.size(), 15u) << "seed " << seed;
    ++refused;
  }
  EXPECT_GT(refused, 40);
  EXPECT_LT(refused, 200);
}

TEST(MalformedBodies, TargetsAreReadOrRefused) {
  expectReadOrRefused(kTarget, [](const std::string& text) { parseTarget(text, "malformed", 4); });
}

TEST(MalformedBodies, FiguresAreReadOrRefused) {
  expectReadOrRefused(kObj, [](const std::string& text) {
    const Figure figure = smallFigure(text, skeletonText(), kWeights);
    bodyOf(figure, figure.mesh.positions, 1.0);
  });
}

TEST(MalformedBodies, SkeletonsAreReadOrRefused) {
  expectReadOrRefused(skeletonText(),
                      [](const std::string& text) { smallFigure(kObj, text, kWeights); });
}

TEST(MalformedBodies, WeightsAreReadOrRefused) {
  expectReadOrRefused(kWeights,
                      [](const std::string& text) { smallFigure(kObj, skeletonText(), text); });
}

TEST_F(BodyFile, MalformedFilesAreReadOrRefused) {
  expectReadOrRefused(kSurface, [this](const std::string& text) { parse(text); });
}

}  // namespace
}  // namespace haptex::garment::test_body_file
