#include <gtest/gtest.h>

#include <cmath>

#include "garment_fixtures.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::garment::test_garment_file {
namespace {

using Eigen::Vector2d;

TEST(GarmentFile, IsReadAsItIsWritten) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  EXPECT_EQ(pattern.source, "made up for tests");
  ASSERT_EQ(pattern.panels.size(), 2u);
  const Panel& front = pattern.panels[0];
  EXPECT_EQ(front.fabric, "wool");
  EXPECT_EQ(front.layer, 1);
  EXPECT_EQ(front.warp, Vector2d(0.0, 1.0));
  ASSERT_EQ(front.outlines.size(), 2u);
  EXPECT_EQ(front.outlines[0].size(), 7u);
  EXPECT_EQ(front.outlines[0][0].name, "hem");
  EXPECT_EQ(front.outlines[0][6].curve.kind(), Curve::Kind::kCubic);
  EXPECT_EQ(front.outlines[1][0].curve.kind(), Curve::Kind::kArc);
  const auto& pose = std::get<Eigen::Isometry3d>(front.placement);
  // Roll and yaw of a right angle: x of the panel along y, y along z of the world.
  EXPECT_NEAR((pose * Eigen::Vector3d(1.0, 2.0, 0.0) - Eigen::Vector3d(0.2, 1.0, 3.0)).norm(), 0.0,
              1e-15);
  const auto& on = std::get<OnCarrier>(pattern.panels[1].placement);
  EXPECT_EQ(on.carrier, "torso");
  EXPECT_EQ(on.angle, 3.14);
  EXPECT_FALSE(isTurnedOver(front));
  EXPECT_TRUE(isTurnedOver(pattern.panels[1]));
}

TEST(GarmentFile, AreasAreExact) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  // The sides bulge by 2/3 of the triangle of their control points.
  // points.
  const double side = 2.0 / 3.0 * 0.5 * 0.05 * 0.6;
  // Of the cubic x = -0.15 t (1 - t), y = 0.6 (1 - t)^3 + ...: -integral of x dy, dy = -0.6 dt.
  const double other = 0.15 / 6.0 * 0.6;
  const double dart = 0.5 * 0.1 * 0.2, hole = M_PI * 0.05 * 0.05;
  EXPECT_NEAR(areaOf(pattern.panels[0]), 0.24 + side + other - dart - hole, 1e-15);
  EXPECT_NEAR(areaOf(pattern.panels[1]), 0.24 + side, 1e-15);
}

TEST(GarmentFile, SeamsRunAlongOutlinesOrAgainstThem) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  ASSERT_EQ(pattern.seams.size(), 3u);
  EXPECT_TRUE(pattern.seams[0].sides[1].reversed);
  EXPECT_EQ(pattern.seams[0].easing, kUsualEasing);
  EXPECT_NEAR(lengthDifference(pattern, pattern.seams[0]), 0.0, 1e-12);
  // Over the corner at which the outline begins.
  EXPECT_EQ(edgesOf(pattern, pattern.seams[1].sides[0]), (std::vector<int>{6, 0}));
  EXPECT_FALSE(isDart(pattern, pattern.seams[1]));
  EXPECT_TRUE(isDart(pattern, pattern.seams[2]));
  EXPECT_NEAR(lengthOf(pattern, pattern.seams[2].sides[0]), std::hypot(0.05, 0.2), 1e-15);
}

TEST(GarmentFile, IsTheSameAfterItWasWritten) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  const std::string written = writePattern(pattern);
  const Pattern again = parsePattern(written, "again.yaml");
  EXPECT_EQ(writePattern(again), written);
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    EXPECT_EQ(areaOf(again.panels[p]), areaOf(pattern.panels[p]));
  }
  ASSERT_EQ(again.seams.size(), pattern.seams.size());
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    EXPECT_EQ(isDart(again, again.seams[s]), isDart(pattern, pattern.seams[s]));
    EXPECT_EQ(lengthOf(again, again.seams[s].sides[0]),
              lengthOf(pattern, pattern.seams[s].sides[0]));
  }
  ASSERT_EQ(again.fastenings.size(), 1u);
  EXPECT_EQ(again.fastenings[0].name, "button");
  EXPECT_EQ(again.fastenings[0].places[1].panel, 1);
  EXPECT_EQ(again.fastenings[0].places[1].at, Vector2d(0.3, 0.2));
}

TEST(GarmentFile, NamesMayHaveAnyCharacter) {
  Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  pattern.panels[0].name = "left \"front\": {\\}\n#1";
  const Pattern again = parsePattern(writePattern(pattern), "again.yaml");
  EXPECT_EQ(again.panels[0].name, pattern.panels[0].name);
}

/// Longer than YAML files of other kinds may be.
TEST(GarmentFile, MayHaveAHundredThousandPoints) {
  Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  pattern.seams.clear();
  pattern.fastenings.clear();
  Panel& panel = pattern.panels.front();
  panel.outlines.resize(1);
  panel.marks.assign(10, std::vector<Vector2d>(10'000, Vector2d(0.123456789, 0.2)));
  const std::string text = writePattern(pattern);
  EXPECT_GT(text.size(), base::kLargestYaml);
  const Pattern again = parsePattern(text, "large.yaml");
  EXPECT_EQ(again.panels.front().marks, panel.marks);
}

TEST(GarmentFile, TheExampleInItsDocumentationIsOne) {
  const std::string page = readPatternText(HAPTEX_SOURCE_DIRECTORY "/docs/garments.md");
  const std::string begin = "```yaml\n";
  const std::size_t at = page.find(begin) + begin.size();
  const Pattern pattern = parsePattern(page.substr(at, page.find("```", at) - at), "garments.md");
  EXPECT_EQ(pattern.panels.size(), 2u);
  EXPECT_EQ(pattern.seams.size(), 2u);
}

TEST(GarmentFile, EndsThatDifferByRoundingAreOneCorner) {
  std::string text = kSmallGarment;
  text.replace(text.find("[0.4, 0.6], [0.25, 0.6]]"), 24, "[0.4000004, 0.6], [0.25, 0.6]]");
  const Pattern pattern = parsePattern(text, "small.yaml");
  EXPECT_EQ(pattern.panels[0].outlines[0][2].curve.start(), Vector2d(0.4, 0.6));
}

}  // namespace
}  // namespace haptex::garment::test_garment_file
