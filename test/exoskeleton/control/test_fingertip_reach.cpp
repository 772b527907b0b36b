#include <gtest/gtest.h>

#include <limits>

#include "emulator_fixtures.h"
#include "haptex/exoskeleton/control/fingertip_reach.h"

namespace haptex::exoskeleton::test_fingertip_reach {
namespace {

using Eigen::Vector3d;

class FingertipReachOf : public testing::TestWithParam<Finger> {
 protected:
  FingertipReachOf() : kinematics_(shippedUrdf(), GetParam()), reach_(shippedUrdf(), GetParam()) {}

  Vector3d position(const MotorVector& angles) {
    return kinematics_.fingertip(kinematics_.jointAngles(angles)).translation();
  }
  MotorVector at(double a, double b, double c) const {
    return reach_.lowest() + Vector3d(a, b, c).cwiseProduct(reach_.highest() - reach_.lowest());
  }
  MotorVector randomAngles() {
    const double a = share_(generator_), b = share_(generator_), c = share_(generator_);
    return at(a, b, c);
  }

  FingerKinematics kinematics_;
  FingertipReach reach_;
  std::mt19937 generator_{1};
  std::uniform_real_distribution<double> share_{0.0, 1.0};
};

TEST_P(FingertipReachOf, KeepsAllFourJointsWithinTheirLimits) {
  for (const MotorVector& angles : {reach_.lowest(), reach_.highest()}) {
    const JointVector joints = kinematics_.jointAngles(angles);
    for (int i = 0; i < kJoints; ++i) {
      EXPECT_GE(joints[i], kinematics_.lowerLimits()[i] - 1e-9);
      EXPECT_LE(joints[i], kinematics_.upperLimits()[i] + 1e-9);
    }
  }
}

TEST_P(FingertipReachOf, MeetsEveryTargetWithinReach) {
  for (int trial = 0; trial < 500; ++trial) {
    const Vector3d target = position(randomAngles());
    const FingertipReach::Place place = reach_.nearest(target, randomAngles());
    EXPECT_LT((place.position - target).norm(), 2.0 * FingertipReach::kTolerance) << trial;
    EXPECT_EQ(place.position, position(place.motor_angles));
    EXPECT_TRUE((place.motor_angles.array() >= reach_.lowest().array()).all());
    EXPECT_TRUE((place.motor_angles.array() <= reach_.highest().array()).all());
  }
}

// Against brute force on a grid of angles, whose best is at most a cell away from the best there
// is.
TEST_P(FingertipReachOf, FindsThePlaceNearestToATargetOutOfReach) {
  constexpr int kCells = 40;
  std::vector<Vector3d> grid;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) {
      for (int k = 0; k <= kCells; ++k) {
        grid.push_back(position(at(i / double{kCells}, j / double{kCells}, k / double{kCells})));
      }
    }
  }
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d target = position(at(0.5, 0.5, 0.5)) + 0.15 * randomDirection(generator_);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& place : grid) nearest = std::min(nearest, (place - target).norm());
    const double found = (reach_.nearest(target, randomAngles()).position - target).norm();
    EXPECT_LT(found, nearest + 1e-3) << trial;
    EXPECT_GT(found, nearest - 0.003) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, FingertipReachOf, testing::ValuesIn(kFingers),
                         [](const auto& info) { return std::string(name(info.param)); });

}  // namespace
}  // namespace haptex::exoskeleton::test_fingertip_reach
