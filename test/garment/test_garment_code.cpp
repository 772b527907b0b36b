#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "../refusal.h"
#include "expected_patterns.h"
#include "garment_fixtures.h"
#include "haptex/garment/importers/garment_code.h"

namespace haptex::garment::test_garment_code {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::string kFiles = HAPTEX_SOURCE_DIRECTORY "/test/garment/patterns/";
const std::string kGarments = HAPTEX_CONFIG_DIRECTORY "/garments/";

std::string replaced(std::string text, const std::string& part, const std::string& replacement) {
  const std::size_t begin = text.find(part);
  if (begin == std::string::npos) throw std::logic_error("no such part: " + part);
  return text.replace(begin, part.size(), replacement);
}

Pattern import(const std::string& part = "", const std::string& replacement = "") {
  return importGarmentCode(replaced(kTwoSquares, part, replacement), "two.json", "wool");
}

std::string refusal(const std::string& part, const std::string& replacement) {
  return test::refusalOf([&] { import(part, replacement); });
}

// The first edge of the front with a curvature.
Curve curved(const std::string& curvature) {
  return import(R"({"endpoints": [0, 1]})",
                R"({"endpoints": [0, 1], "curvature": )" + curvature + "}")
      .panels[0]
      .outlines[0][0]
      .curve;
}

void expectPattern(const Pattern& pattern, const ExpectedPattern& expected) {
  ASSERT_EQ(pattern.panels.size(), expected.areas.size());
  for (std::size_t p = 0; p < expected.areas.size(); ++p) {
    EXPECT_EQ(pattern.panels[p].name, expected.areas[p].first);
    EXPECT_NEAR(areaOf(pattern.panels[p]), expected.areas[p].second, 1e-12);
  }
  ASSERT_EQ(pattern.seams.size(), expected.seam_lengths.size());
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    EXPECT_NEAR(lengthOf(pattern, pattern.seams[s].sides[0]), expected.seam_lengths[s].first,
                1e-12);
    EXPECT_NEAR(lengthOf(pattern, pattern.seams[s].sides[1]), expected.seam_lengths[s].second,
                1e-12);
    // All of them join right sides, at opposite ends.
    EXPECT_TRUE(pattern.seams[s].sides[1].reversed) << s;
  }
}

TEST(GarmentCode, AreasAndSeamsOfPublicPatternsAreThoseOfAnotherProgram) {
  const std::string shirt = readPatternText(kFiles + "shirt_mean_specification.json");
  expectPattern(importGarmentCode(shirt, "shirt", "wool"), kExpectedShirt);
  const std::string dress = readPatternText(kFiles + "dress_pencil_specification.json");
  const Pattern pattern = importGarmentCode(dress, "dress", "wool");
  expectPattern(pattern, kExpectedDress);
  int darts = 0;
  for (const Seam& seam : pattern.seams) darts += isDart(pattern, seam) ? 1 : 0;
  EXPECT_EQ(darts, 4);
}

TEST(GarmentCode, TheShippedGarmentsAreTheseFilesImported) {
  const std::pair<std::string, std::string> shipped[] = {
      {"shirt_mean_specification.json", "shirt.yaml"},
      {"dress_pencil_specification.json", "pencil_dress.yaml"}};
  for (const auto& [json, yaml] : shipped) {
    Pattern imported = importGarmentCode(readPatternText(kFiles + json), json, "wool");
    const Pattern garment = loadPattern(kGarments + yaml);
    imported.source = garment.source;
    EXPECT_EQ(writePattern(imported), writePattern(garment)) << yaml;
  }
}

TEST(GarmentCode, PanelsLieInTheWorldAsTheyLieInTheFile) {
  const Pattern pattern = import();
  const auto& front = std::get<Eigen::Isometry3d>(pattern.panels[0].placement);
  const auto& back = std::get<Eigen::Isometry3d>(pattern.panels[1].placement);
  // x left of the body, y up, z forward: (z, x, y) of the world, in metres.
  EXPECT_NEAR((front * Vector3d(0.2, 0.1, 0.0) - Vector3d(0.1, 0.2, 1.1)).norm(), 0.0, 1e-15);
  // Turned about the vertical axis.
  EXPECT_NEAR((back * Vector3d(0.2, 0.1, 0.0) - Vector3d(-0.1, 0.0, 1.1)).norm(), 0.0, 1e-15);
  // About x first, then y, then z: the file's y goes to z, which the turn about y takes to x.
  const Pattern turned = import("\"rotation\": [0, 0, 0]", "\"rotation\": [90, 90, 0]");
  const auto& pose = std::get<Eigen::Isometry3d>(turned.panels[0].placement);
  EXPECT_NEAR((pose.linear() * Vector3d::UnitY() - Vector3d(0.0, 1.0, 0.0)).norm(), 0.0, 1e-15);
}

TEST(GarmentCode, PanelsThatTheFileDoesNotPlaceLieInTheOrigin) {
  const Pattern pattern = import(R"("translation": [0, 100, 10], "rotation": [0, 0, 0],)", "");
  const auto& pose = std::get<Eigen::Isometry3d>(pattern.panels[0].placement);
  EXPECT_EQ(pose.translation(), Vector3d::Zero());
}

TEST(GarmentCode, LengthsAreInTheFilesUnit) {
  const Pattern pattern = import("\"units_in_meter\": 100", "\"units_in_meter\": 1000");
  EXPECT_NEAR(areaOf(pattern.panels[0]), 0.02 * 0.02, 1e-15);
  EXPECT_NEAR(areaOf(import("\"units_in_meter\": 100, ", "").panels[0]), 0.2 * 0.2, 1e-15);
}

TEST(GarmentCode, PanelsMayBeMovedToTheirMiddle) {
  const Pattern pattern =
      import("\"units_in_meter\"", "\"normalize_panel_translation\": true, \"units_in_meter\"");
  EXPECT_EQ(pattern.panels[0].outlines[0][0].curve.start(), Vector2d(-0.1, -0.1));
  const auto& pose = std::get<Eigen::Isometry3d>(pattern.panels[0].placement);
  EXPECT_NEAR((pose.translation() - Vector3d(0.1, 0.1, 1.1)).norm(), 0.0, 1e-15);
}

TEST(GarmentCode, ControlPointsAreRelativeToTheEdge) {
  // From (0, 0) to (0.2, 0): x along it, y to its left.
  const Curve quadratic = curved(R"({"type": "quadratic", "params": [[0.5, 0.2]]})");
  EXPECT_EQ(quadratic.kind(), Curve::Kind::kQuadratic);
  EXPECT_NEAR((quadratic.points()[1] - Vector2d(0.1, 0.04)).norm(), 0.0, 1e-16);
  EXPECT_EQ(curved("[0.5, 0.2]").points(), quadratic.points());
  const Curve cubic = curved(R"({"type": "cubic", "params": [[0.2, 0.1], [0.8, -0.1]]})");
  EXPECT_NEAR((cubic.points()[1] - Vector2d(0.04, 0.02)).norm(), 0.0, 1e-16);
  EXPECT_NEAR((cubic.points()[2] - Vector2d(0.16, -0.02)).norm(), 0.0, 1e-16);
}

TEST(GarmentCode, ControlPointsMayBeAbsolute) {
  std::string text = replaced(kTwoSquares, "relative", "absolute");
  text =
      replaced(text, R"({"endpoints": [0, 1]})", R"({"endpoints": [0, 1], "curvature": [10, -4]})");
  const Pattern pattern = importGarmentCode(text, "two.json", "wool");
  EXPECT_EQ(pattern.panels[0].outlines[0][0].curve.points()[1], Vector2d(0.1, -0.04));
}

TEST(GarmentCode, CirclesAreGivenByRadiusAndTwoFlags) {
  // 20 cm apart on a circle of 12.5 cm: the centre is 7.5 cm from the chord.
  const double half_angle = std::asin(0.8);
  const Curve small = curved(R"({"type": "circle", "params": [12.5, 0, 1]})");
  EXPECT_NEAR(small.length(), 2.0 * half_angle * 0.125, 1e-14);
  EXPECT_NEAR((small.at(0.5) - Vector2d(0.1, -0.05)).norm(), 0.0, 1e-15);
  const Curve clockwise = curved(R"({"type": "circle", "params": [12.5, 0, 0]})");
  EXPECT_NEAR((clockwise.at(0.5) - Vector2d(0.1, 0.05)).norm(), 0.0, 1e-15);
  const Curve large = curved(R"({"type": "circle", "params": [12.5, 1, 1]})");
  EXPECT_NEAR(large.length(), 2.0 * (M_PI - half_angle) * 0.125, 1e-14);
  EXPECT_NEAR((large.at(0.5) - Vector2d(0.1, -0.2)).norm(), 0.0, 1e-15);
}

TEST(GarmentCode, StitchesJoinTheEndsThatMeetInThePlacement) {
  // The file says that right sides face outwards; opposite ends meet.
  EXPECT_TRUE(import().seams[0].sides[1].reversed);
  // The back is not turned over: starts lie over starts.
  const std::string not_turned = R"([0, 100, -1], "rotation": [0, 0, 0])";
  const Pattern starts = importGarmentCode(
      replaced(replaced(kTwoSquares, R"([20, 100, -10], "rotation": [0, 180, 0])", not_turned),
               R"("back", "edge": 3)", R"("back", "edge": 1)"),
      "two.json", "wool");
  EXPECT_FALSE(starts.seams[0].sides[1].reversed);
  // What the file says wins.
  EXPECT_FALSE(
      import(R"("edge": 3}])", R"("edge": 3}, "right_wrong"])").seams[0].sides[1].reversed);
}

TEST(GarmentCode, PanelsStandInTheirOrder) {
  const Pattern pattern =
      import(R"("stitches")", R"("panel_order": ["back", "front"], "stitches")");
  EXPECT_EQ(pattern.panels[0].name, "back");
  EXPECT_EQ(pattern.seams[0].sides[0].panel, 1);
}

TEST(GarmentCode, EasingIsWhatTheFileHas) {
  EXPECT_EQ(import().seams[0].easing, kUsualEasing);
  const Pattern eased = import(R"("vertices": [[0, 0], [20, 0], [20, 20], [0, 20]])",
                               R"("vertices": [[0, 0], [20, 0], [20, 25], [0, 20]])");
  EXPECT_NEAR(eased.seams[0].easing, 0.2, 1e-15);
}

TEST(GarmentCode, RefusesWhatItCannotRead) {
  const std::array<const char*, 3> refused[] = {
      {"[20, 0]", "[\"20\", 0]",
       "two.json: pattern.panels.front.vertices[1][0]: is \"20\", must be a number"},
      {"[20, 0]", "[20, 0, 0]",
       "two.json: pattern.panels.front.vertices[1]: is array, must be a list of 2"},
      {"[20, 0]", "[1e13, 0]",
       "two.json: pattern.panels.front.vertices[1][0]: is 10000000000000.0, must be a number up to "
       "1e12"},
      {"[20, 0]", "[1e6, 0]",
       "two.json: pattern.panels.front.edges[0]: a point has the coordinate 10000 m: allowed are "
       "finite ones up to 1000 m"},
      {"[20, 0]", "[3000, 0]",
       "two.json: panel 'front', edge 0: has the point (30, 0): allowed are up to 20 m in each "
       "direction"},
      {"\"endpoints\": [0, 1]", "\"endpoints\": [0, 4]",
       "two.json: pattern.panels.front.edges[0].endpoints[1]: is 4, must be a whole number from 0 "
       "to 3"},
      {"\"endpoints\": [0, 1]", "\"endpoints\": [0, 2]",
       "two.json: panel 'front', edge 0: ends at (0.2, 0.2), 0.2 m from where edge 1 starts: the "
       "outline is open, allowed is a gap of 1e-06 m"},
      {"{\"endpoints\": [0, 1]}",
       "{\"endpoints\": [0, 1], \"curvature\": {\"type\": \"spline\", "
       "\"params\": []}}",
       "two.json: pattern.panels.front.edges[0].curvature.type: is \"spline\", must be "
       "\"quadratic\", \"cubic\" or \"circle\""},
      {"{\"endpoints\": [0, 1]}",
       "{\"endpoints\": [0, 1], \"curvature\": {\"type\": \"circle\", "
       "\"params\": [9, 0, 1]}}",
       "two.json: pattern.panels.front.edges[0].curvature.params: the radius is 0.09 m: allowed "
       "are "
       "0.1, half the distance of its ends, to 1000"},
      {"\"edges\": [{", "\"sides\": [{", "two.json: pattern.panels.front: 'edges' is missing"},
      {"\"panel\": \"back\"", "\"panel\": \"sleeve\"",
       "two.json: pattern.stitches[0][1].panel: is \"sleeve\", must be the name of a panel"},
      {"\"edge\": 3}", "\"edge\": 4}",
       "two.json: pattern.stitches[0][1].edge: is 4, must be a whole number from 0 to 3"},
      {"\"edge\": 3}", "\"edge\": 3}, \"wrong_right\"",
       "two.json: pattern.stitches[0][2]: is \"wrong_right\", must be \"right_wrong\""},
      {"\"panel\": \"back\", \"edge\": 3", "\"panel\": \"front\", \"edge\": 1",
       "two.json: seam 0: sews panel 'front', edge 1 to itself: the sides of a seam must be "
       "different edges"},
      {"relative", "polar",
       "two.json: properties.curvature_coords: is \"polar\", must be \"relative\" or \"absolute\""},
      {"\"units_in_meter\": 100", "\"units_in_meter\": 0",
       "two.json: properties.units_in_meter: is 0, must be >= 0.01"},
      {"\"pattern\"", "\"patterns\"", "two.json: 'pattern' is missing"},
  };
  for (const auto& [part, replacement, message] : refused) {
    EXPECT_EQ(refusal(part, replacement), message) << part;
  }
  EXPECT_EQ(refusal("{\"pattern\"", "[\"pattern\"").substr(0, 22), "two.json: is not JSON:");
  EXPECT_EQ(refusal("[20, 0]", "[1e999, 0]").substr(0, 22), "two.json: is not JSON:");
}

}  // namespace
}  // namespace haptex::garment::test_garment_code
