#include <gtest/gtest.h>

#include "haptex/base/constants.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles::test_contact_scenes {
namespace {

using base::Finger;
using Eigen::Vector3d;

material::Fabric wool() {
  return material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
}

/// 8 x 8 cells of 5 mm, held at all sides.
HapticLoopSettings smallTautSample() {
  HapticLoopSettings sample;
  sample.mesh = mesh::makeRectangle(0.04, 0.04, 8, 8, mesh::Triangulation::kAlternating);
  sample.fabric = wool();
  sample.effects.viscosity = true;
  sample.haptics.refinement = 1;
  sample.large_scale_step = 0.012;
  for (std::size_t i = 0; i < sample.mesh.rest_coordinates.size(); ++i) {
    const Eigen::Vector2d& rest = sample.mesh.rest_coordinates[i];
    if (rest.minCoeff() < 1e-9 || rest.maxCoeff() > 0.04 - 1e-9) {
      sample.attached_particles.push_back(static_cast<int>(i));
    }
  }
  return sample;
}

Hand handOnSmallSample() {
  Hand hand;
  hand.middle.z() = -0.02;
  hand.gap = 1e-3;
  return hand;
}

TEST(ContactScenes, TheWoolSampleWeighsWhatItsDensitySays) {
  EXPECT_NEAR(weight(hangingSample(wool(), kes::Direction::kWarp, 50.0)),
              0.15 * 0.04 * base::kStandardGravity, 1e-12);
}

TEST(ContactScenes, TheHangingSampleHasTheDirectionOfTheFabricUpwards) {
  for (kes::Direction up : {kes::Direction::kWeft, kes::Direction::kWarp}) {
    const HapticLoopSettings sample = hangingSample(wool(), up, 50.0);
    ASSERT_EQ(sample.attached_particles.size(), 33u);
    for (int particle : sample.attached_particles) {
      EXPECT_NEAR(sample.mesh.initial_positions[particle].z(), 0.0, 1e-15);
    }
    const int axis = up == kes::Direction::kWeft ? 0 : 1;
    for (std::size_t i = 1; i < sample.mesh.rest_coordinates.size(); ++i) {
      const double along =
          std::abs(sample.mesh.rest_coordinates[i][axis] - sample.mesh.rest_coordinates[0][axis]);
      const Vector3d way = sample.mesh.initial_positions[i] - sample.mesh.initial_positions[0];
      EXPECT_NEAR(std::abs(way.z()), along, 1e-12);
    }
  }
}

TEST(ContactScenes, TheTautSampleIsHeldAtAllSidesAndStretchedEvenly) {
  const HapticLoopSettings sample = tautSample(wool(), 0.01, 25.0);
  EXPECT_EQ(sample.attached_particles.size(), 128u);
  EXPECT_NEAR(sample.large_scale_step, 0.04, 1e-15);
  const auto& positions = sample.mesh.initial_positions;
  EXPECT_NEAR((positions.front() - positions.back()).norm(), 1.01 * std::sqrt(2.0) * 0.2, 1e-12);
  EXPECT_NEAR((0.5 * (positions.front() + positions.back()) - Vector3d(0, 0, -0.1)).norm(), 0.0,
              1e-12);
}

TEST(Hand, ItsFingertipsMeetFaceToFaceWithTheGapBetweenThem) {
  Hand hand;
  hand.middle = {0.01, 0.02, 0.03};
  hand.gap = 1e-3;
  hand.velocity = {0.0, 0.1, 0.0};
  hand.opening = 0.2;
  const Fingertips fingertips = hand.fingertips();
  const Vector3d apart =
      fingertips[Finger::kIndex]->position - fingertips[Finger::kThumb]->position;
  EXPECT_NEAR(apart.x(), kIndexRadius + kThumbRadius + 1e-3, 1e-15);
  EXPECT_EQ(apart.tail<2>().norm(), 0.0);
  EXPECT_EQ(fingertips[Finger::kIndex]->velocity, Vector3d(0.1, 0.1, 0.0));
  EXPECT_EQ(fingertips[Finger::kThumb]->velocity, Vector3d(-0.1, 0.1, 0.0));
}

TEST(Hand, MovesInWholeStepsWhoseVelocitiesAreThoseOfTheWayAndStops) {
  Hand hand;
  Vector3d before = hand.fingertips()[Finger::kIndex]->position;
  int steps = 0;
  move(hand, {0.0, 0.0, 0.01}, -1e-3, 0.1, 0.01, [&](const Fingertips& fingertips) {
    ++steps;
    const Vector3d way = fingertips[Finger::kIndex]->position - before;
    EXPECT_NEAR((way / 0.01 - fingertips[Finger::kIndex]->velocity).norm(), 0.0, 1e-12);
    before = fingertips[Finger::kIndex]->position;
  });
  EXPECT_EQ(steps, 10);
  EXPECT_NEAR(hand.middle.z(), 0.01, 1e-15);
  EXPECT_NEAR(hand.gap, -1e-3, 1e-15);
  EXPECT_EQ(hand.fingertips()[Finger::kIndex]->velocity, Vector3d(0.0, 0.0, 0.0));
}

TEST(RefinedCloth, FeelsWhatTheTwoLayersFeelOfAPinch) {
  const HapticLoopSettings sample = smallTautSample();
  Hand hand = handOnSmallSample();
  HapticLoop loop(sample);
  move(hand, Vector3d::Zero(), -2e-3, 0.1, 1e-3, [&](const Fingertips& f) { loop.step(f); });
  loop.rest(hand.fingertips(), 0.2);
  hand = handOnSmallSample();
  RefinedCloth cloth(sample);
  move(hand, Vector3d::Zero(), -2e-3, 0.1, 0.01, [&](const Fingertips& f) { cloth.step(f, 0.01); });
  for (int i = 0; i < 10; ++i) cloth.step(hand.fingertips(), 0.05);
  const double force = loop.layer().contacts()[Finger::kIndex].force.x();
  ASSERT_GT(force, 0.02);
  // The sheet stays plane: rim and large-scale cloth have little part in the force.
  EXPECT_NEAR(cloth.force(Finger::kIndex).x(), force, 0.01 * force);
  EXPECT_NEAR(cloth.force(Finger::kIndex).x(), -cloth.force(Finger::kThumb).x(), 0.05 * force);
}

TEST(HapticLoop, RefusesAFingertipOfAnotherRadius) {
  HapticLoop loop(smallTautSample());
  Hand hand = handOnSmallSample();
  hand.thumb_radius = kIndexRadius;
  EXPECT_THROW(loop.step(hand.fingertips()), std::invalid_argument);
}

TEST(HapticLoop, AFingertipThatIsAbsentDoesNotTouch) {
  HapticLoop loop(smallTautSample());
  Hand hand = handOnSmallSample();
  hand.gap = -1e-3;
  loop.rest(hand.fingertips(), 0.05);
  EXPECT_TRUE(loop.layer().contacts()[Finger::kIndex].touching);
  loop.step({});
  EXPECT_FALSE(loop.layer().contacts()[Finger::kIndex].touching);
}

}  // namespace
}  // namespace haptex::oracles::test_contact_scenes
