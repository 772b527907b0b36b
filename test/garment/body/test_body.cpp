#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "../../refusal.h"
#include "body_fixtures.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/body/measured_body.h"
#include "haptex/garment/body/measurements.h"

namespace haptex::garment::test_body {
namespace {

using Eigen::Vector3d;

std::string refusalOf(FigureShape shape, const Measures& asked) {
  return test::refusalOf([&] { measuredBody(bodyPath("makehuman"), shape, asked); });
}

TEST(Body, ShippedBodiesAreClosedAndStandOnTheGround) {
  for (const char* name : {"woman", "man", "woman_arms_down"}) {
    const Body body = loadBody(bodyPath(std::string(name) + ".yaml"));
    EXPECT_TRUE(isClosed(body.triangles)) << name;
    const auto lowest =
        std::min_element(body.vertices.begin(), body.vertices.end(),
                         [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
    EXPECT_EQ(lowest->z(), 0.0) << name;
    // People have about the density of water.
    EXPECT_GT(volumeOf(body), 0.05) << name;
    EXPECT_LT(volumeOf(body), 0.08) << name;
  }
}

TEST(Body, FacesForwardWithItsLeftOnTheLeft) {
  const Body body = loadBody(bodyPath("woman.yaml"));
  const Segment& foot = body.segments[segmentNamed(body, "left_foot")];
  EXPECT_GT((foot.end - foot.start).x(), 0.1);
  EXPECT_GT(foot.start.y(), 0.05);
  const Segment& other = body.segments[segmentNamed(body, "right_foot")];
  EXPECT_NEAR((foot.start - Vector3d(other.start.x(), -other.start.y(), other.start.z())).norm(),
              0.0, 1e-3);
  EXPECT_THROW(segmentNamed(body, "tail"), std::invalid_argument);
}

TEST(Body, MeasurementsAreWhatIsAskedFor) {
  const std::vector<std::pair<FigureShape, Measures>> cases = {
      {FigureShape::kFemale, {{"height", 1.75}, {"chest", 0.95}, {"waist", 0.75}, {"hips", 1.05}}},
      {FigureShape::kFemale, {{"waist", 0.60}, {"neck", 0.30}, {"wrist", 0.15}}},
      {FigureShape::kMale,
       {{"height", 1.70}, {"chest", 1.02}, {"waist", 0.80}, {"hips", 1.0}, {"upper_arm", 0.32}}},
      {FigureShape::kMale,
       {{"height", 1.90},
        {"upper_arm_length", 0.28},
        {"forearm_length", 0.26},
        {"thigh_length", 0.48},
        {"shank_length", 0.46},
        {"thigh", 0.55},
        {"knee", 0.38},
        {"calf", 0.40},
        {"ankle", 0.25}}},
  };
  for (const auto& [shape, asked] : cases) {
    const Body body = measuredBody(bodyPath("makehuman"), shape, asked);
    for (const auto& [name, value] : asked) {
      EXPECT_NEAR(measure(body, name), value, 1e-6) << name;
    }
    EXPECT_TRUE(isClosed(body.triangles));
  }
}

TEST(Body, MeasurementsOutOfReachAreRefusedWithWhatIsAllowed) {
  EXPECT_EQ(refusalOf(FigureShape::kFemale, {{"height", 2.5}}),
            "height is 2.5 m: allowed are 1.285 to 1.926 m beside the other measurements");
  EXPECT_EQ(refusalOf(FigureShape::kFemale, {{"waist", 1.2}}),
            "waist is 1.2 m: allowed are 0.572 to 0.766 m beside the other measurements");
  EXPECT_EQ(refusalOf(FigureShape::kFemale, {{"waist", -1.0}}),
            "waist is -1 m: allowed are finite lengths > 0");
  EXPECT_EQ(refusalOf(FigureShape::kMale, {{"tail", 1.0}}).substr(0, 40),
            "measurement 'tail' is unknown: there are");
}

TEST(Body, TapeGoesAroundThePlaneSectionAndAcrossHollows) {
  const Body prism = makePrism(0.1, 1.0, 24);
  EXPECT_NEAR(measure(prism, "chest"), 24 * 0.2 * std::sin(M_PI / 24), 1e-14);
  EXPECT_EQ(measure(prism, "height"), 1.0);
  // Every other edge pressed inwards: the tape goes straight from corner to corner.
  Body star = makePrism(0.1, 1.0, 24);
  for (std::size_t i = 4; i + 1 < star.vertices.size(); i += 4) {
    for (std::size_t k : {i, i + 1}) star.vertices[k].head<2>() *= 0.7;
  }
  EXPECT_NEAR(measure(star, "waist"), 12 * 0.2 * std::sin(M_PI / 12), 1e-14);
}

TEST(Body, PoseTurnsSegmentsAsRigidBodies) {
  const Body body = loadBody(bodyPath("woman_arms_down.yaml"));
  const Body figure =
      measuredBody(bodyPath("makehuman"), FigureShape::kFemale,
                   {{"height", 1.68}, {"chest", 0.90}, {"waist", 0.72}, {"hips", 0.98}});
  const int hand = segmentNamed(body, "left_hand");
  std::vector<std::size_t> rigid;
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    const SegmentShare& most = body.shares[i].front();
    if (most.segment == hand && most.weight == 1.0) rigid.push_back(i);
  }
  ASSERT_GT(rigid.size(), 100u);
  for (std::size_t i = 1; i < rigid.size(); ++i) {
    EXPECT_NEAR((body.vertices[rigid[i]] - body.vertices[rigid[0]]).norm(),
                (figure.vertices[rigid[i]] - figure.vertices[rigid[0]]).norm(), 1e-14);
  }
  const Segment& arm = body.segments[segmentNamed(body, "left_upper_arm")];
  EXPECT_LT((arm.end - arm.start).normalized().z(), -0.97);  // hangs
  EXPECT_NEAR((arm.end - body.segments[segmentNamed(body, "left_forearm")].start).norm(), 0.0,
              1e-14);
}

TEST(Body, TurnOfTheRootTurnsEverything) {
  const Body body = loadBody(bodyPath("man.yaml"));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d::UnitZ()));
  const Body turned = posed(body, {{"spine", turn}});
  const Vector3d start = body.segments[0].start;
  for (std::size_t i = 0; i < body.vertices.size(); i += 97) {
    const Vector3d expected = turn * (body.vertices[i] - start) + start;
    EXPECT_NEAR((turned.vertices[i] - expected).norm(), 0.0, 1e-12);
  }
  EXPECT_THROW(posed(body, {{"tail", turn}}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::garment::test_body
