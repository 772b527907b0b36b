#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "haptex/exoskeleton/emulator/hand_motion.h"

namespace haptex::exoskeleton::test_hand_motion {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Time kStart = std::chrono::hours(100);
constexpr Time kLength = std::chrono::seconds(1);

/// From 0 to (1, 0, 0) m in kLength, all of it.
HandMotion straightMotion() {
  KeyFrame first{0.0, {}};
  KeyFrame last{seconds(kLength), {}};
  for (const Finger finger : kFingers) {
    last.place.fingertips[finger] = Eigen::Vector3d::UnitX();
  }
  last.place.hand_base.translation() = Eigen::Vector3d::UnitX();
  return HandMotion(HandPath({first, last}, false));
}

TEST(HandMotion, FollowsThePathFromTheFirstTimeItIsAskedAt) {
  HandMotion motion = straightMotion();
  EXPECT_EQ(motion.at(kStart).fingertips[Finger::kIndex], Eigen::Vector3d::Zero());
  // Minimum jerk is half way after half of the time.
  EXPECT_NEAR(motion.at(kStart + kLength / 2).fingertips[Finger::kThumb].x(), 0.5, 1e-12);
  EXPECT_NEAR(motion.at(kStart + kLength).hand_base.translation().x(), 1.0, 1e-12);
}

TEST(HandMotion, KeepsWhatWasTakenAndFollowsThePathWithTheRest) {
  HandMotion motion = straightMotion();
  motion.at(kStart);
  const Eigen::Vector3d target(0.1, 0.2, 0.3);
  motion.receive(Finger::kIndex, target);
  HandPlace place = motion.at(kStart + kLength);
  EXPECT_EQ(place.fingertips[Finger::kIndex], target);
  EXPECT_NEAR(place.fingertips[Finger::kThumb].x(), 1.0, 1e-12);
  EXPECT_NEAR(place.hand_base.translation().x(), 1.0, 1e-12);

  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.0, 0.5, 0.0);
  motion.receive(pose);
  place = motion.at(kStart + kLength);
  EXPECT_TRUE(place.hand_base.isApprox(pose, 0.0));
  EXPECT_EQ(place.fingertips[Finger::kIndex], target);
}

TEST(HandMotion, RefusesWhatIsNotFiniteOrFarAwayAndChangesNothing) {
  HandMotion motion = straightMotion();
  motion.at(kStart);
  const double beyond = 1.001 * HandMotion::kFarthest;
  for (const double wrong : {kNaN, kInfinity, -kInfinity, beyond, -beyond, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d position = wrong * Eigen::Vector3d::Unit(axis);
      EXPECT_THROW(motion.receive(Finger::kIndex, position), std::invalid_argument);
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = position;
      EXPECT_THROW(motion.receive(pose), std::invalid_argument);
    }
  }
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear()(1, 2) = kNaN;
  EXPECT_THROW(motion.receive(turned), std::invalid_argument);
  const HandPlace place = motion.at(kStart + kLength);
  EXPECT_NEAR(place.fingertips[Finger::kIndex].x(), 1.0, 1e-12);
  EXPECT_NEAR(place.hand_base.translation().x(), 1.0, 1e-12);
}

TEST(HandMotion, SaysWhatIsAllowed) {
  HandMotion motion = straightMotion();
  try {
    motion.receive(Finger::kThumb, {0.0, 11.0, 0.0});
    FAIL() << "took a target out of reach";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "target = ( 0 11  0): allowed are finite coordinates from -10 to 10 m");
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_hand_motion
