#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "emulator_fixtures.h"
#include "haptex/exoskeleton/control/workspace.h"

namespace haptex::exoskeleton::test_workspace {
namespace {

using Eigen::Vector3d;

TEST(Workspace, IsACubeOf400MillimetresAroundTheSample) {
  EXPECT_DOUBLE_EQ(distanceToWorkspaceRim({0.0, 0.0, -0.1}), 0.2);
  EXPECT_NEAR(distanceToWorkspaceRim({0.0, -0.15, -0.2}), 0.05, 1e-12);
  EXPECT_NEAR(distanceToWorkspaceRim({0.0, 0.0, 0.13}), -0.03, 1e-12);
}

class RimOfTheReachOf : public testing::TestWithParam<Finger> {};
INSTANTIATE_TEST_SUITE_P(Both, RimOfTheReachOf, testing::ValuesIn(kFingers),
                         [](const auto& tested) { return name(tested.param); });

TEST_P(RimOfTheReachOf, ReachesEverythingThatIsNearerThanItsRim) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  const EmulatedFinger finger(shippedUrdf(), GetParam());
  std::mt19937 generator(5);
  for (int i = 0; i < 1000; ++i) {
    const MotorVector angles = randomAngles(finger, generator, 0.02);
    const JointVector joints = kinematics.jointAngles(angles);
    const double distance = rim.distance(joints);
    ASSERT_GE(distance, 0.0);
    const Vector3d target =
        kinematics.fingertip(joints).translation() + 0.99 * distance * randomDirection(generator);
    EXPECT_LT((reach.nearest(target, angles).position - target).norm(), FingertipReach::kTolerance)
        << "at " << distance << " m";
  }
}

// The nearest of many places with a joint at a limit, by brute force.
TEST_P(RimOfTheReachOf, TheDistanceIsThatToTheNearestPlaceWithAJointAtALimit) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  const EmulatedFinger finger(shippedUrdf(), GetParam());
  std::mt19937 generator(6);
  const std::vector<Vector3d> corners = rim.surface(60);  // at most 2 mm apart
  for (int i = 0; i < 20; ++i) {
    const JointVector joints = kinematics.jointAngles(randomAngles(finger, generator, 0.02));
    const Vector3d tip = kinematics.fingertip(joints).translation();
    double nearest = 1.0;
    for (const Vector3d& corner : corners) nearest = std::min(nearest, (corner - tip).norm());
    EXPECT_LE(rim.distance(joints), nearest + FingertipReach::kTolerance);
    EXPECT_GT(rim.distance(joints), nearest - 1.5e-3);
  }
}

TEST_P(RimOfTheReachOf, ThereIsNoWayLeftAtALimitAndLessThanNoneBeyond) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  MotorVector angles = 0.5 * (reach.lowest() + reach.highest());
  angles[0] = reach.lowest()[0];
  EXPECT_NEAR(rim.distance(kinematics.jointAngles(angles)), 0.0, FingertipReach::kTolerance);
  angles[0] -= 0.5;
  EXPECT_LT(rim.distance(kinematics.jointAngles(angles)), 0.0);
}

TEST_P(RimOfTheReachOf, EveryCornerOfTheSurfaceIsAtTheRim) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  constexpr int kCells = 2;
  const std::vector<Vector3d> corners = rim.surface(kCells);
  EXPECT_EQ(corners.size(), 6U * kCells * kCells * 6U);
  for (const Vector3d& corner : corners) {
    const auto found = reach.nearest(corner, 0.5 * (reach.lowest() + reach.highest()));
    EXPECT_LT((found.position - corner).norm(), FingertipReach::kTolerance);
    // In m: singular poses and limits alike.
    EXPECT_LT(rim.distance(kinematics.jointAngles(found.motor_angles)), 1e-3);
  }
}

TEST(RimWarning, StaysUntilTheRimIsClearlyLeft) {
  RimWarning warning(0.003, 0.005);
  EXPECT_FALSE(warning.update(0.004));
  EXPECT_TRUE(warning.update(0.003));
  EXPECT_TRUE(warning.update(0.004));
  EXPECT_FALSE(warning.update(0.0051));
  EXPECT_TRUE(warning.update(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_workspace
