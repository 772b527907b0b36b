#include <gtest/gtest.h>

#include <limits>
#include <random>

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

// Places at less than the distance are reached, whatever the direction: 0.9, and 1 mm for what is
// not of first order.
TEST_P(RimOfTheReachOf, ReachesEverythingThatIsNearerThanItsRim) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  const EmulatedFinger finger(shippedUrdf(), GetParam());
  std::mt19937 generator(5);
  for (int i = 0; i < 200; ++i) {
    const MotorVector angles = randomAngles(finger, generator, 0.02);
    const JointVector joints = kinematics.jointAngles(angles);
    const double distance = rim.distance(joints);
    ASSERT_GE(distance, 0.0);
    const Vector3d target =
        kinematics.fingertip(joints).translation() + 0.9 * distance * randomDirection(generator);
    EXPECT_LT((reach.nearest(target, angles).position - target).norm(), 1e-3);
  }
}

TEST_P(RimOfTheReachOf, TheDistanceIsThatToTheNearestPlaceWithAJointAtALimit) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  MotorVector angles = 0.5 * (reach.lowest() + reach.highest());
  constexpr double kLeft = 0.05;  // rad of a motor: what is not of first order is 1 %
  angles[1] = reach.highest()[1] - kLeft;
  const JointVector joints = kinematics.jointAngles(angles);
  const Vector3d tip = kinematics.fingertip(joints).translation();
  const Vector3d gradient = kinematics.motorJacobian(joints).inverse().row(1).transpose();
  const double distance = rim.distance(joints);
  EXPECT_NEAR(distance, kLeft / gradient.norm(), 1e-12);
  const auto beyond = [&](double share) {
    const Vector3d target = tip + share * distance * gradient.normalized();
    return (reach.nearest(target, angles).position - target).norm();
  };
  EXPECT_LT(beyond(0.95), FingertipReach::kTolerance);
  EXPECT_NEAR(beyond(2.0), distance, 0.1 * distance);
}

TEST_P(RimOfTheReachOf, ThereIsNoWayLeftAtALimitAndLessThanNoneBeyond) {
  ReachRim rim(shippedUrdf(), GetParam());
  FingerKinematics kinematics(shippedUrdf(), GetParam());
  FingertipReach reach(shippedUrdf(), GetParam());
  MotorVector angles = 0.5 * (reach.lowest() + reach.highest());
  angles[0] = reach.lowest()[0];
  EXPECT_NEAR(rim.distance(kinematics.jointAngles(angles)), 0.0, 1e-12);
  angles[0] -= 0.1;
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
