#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "haptex/exoskeleton/control/hand_gravity.h"

namespace haptex::exoskeleton::test_hand_gravity {
namespace {

using namespace std::chrono_literals;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

const Vector3d kDown(0.0, 0.0, -base::kStandardGravity);

/// Ticks of 1 ms from `from` until `to`.
const Vector3d& tickUntil(HandGravity& gravity, Time from, Time to) {
  for (Time now = from; now < to; now += 1ms) gravity.tick(now);
  return gravity.tick(to);
}

/// Told at 1 s that the hand is upright, and known since.
HandGravity known() {
  HandGravity gravity;
  gravity.tick(1s);
  gravity.receive(kDown, 1s);
  tickUntil(gravity, 1s, 1200ms);
  return gravity;
}

TEST(HandGravity, IsSeenByATurnedHandInItsOwnAxes) {
  EXPECT_EQ(gravityIn(Eigen::Matrix3d::Identity()), kDown);
  // Rolled by 90 degrees the hand's y axis points up.
  const Eigen::Matrix3d rolled = AngleAxisd(M_PI / 2.0, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(gravityIn(rolled).isApprox(Vector3d(0.0, -base::kStandardGravity, 0.0), 1e-12));
}

TEST(HandGravity, IsNotKnownBeforeAnybodySaysIt) {
  HandGravity gravity;
  EXPECT_TRUE(tickUntil(gravity, 0s, 300ms).isZero(0.0));
}

TEST(HandGravity, ComesWithinItsFadeWithoutAJump) {
  HandGravity gravity;
  gravity.tick(1s);
  gravity.receive(kDown, 1s);
  // A step of 1 ms is a hundredth of the fade.
  EXPECT_NEAR(gravity.tick(1001ms).norm(), 0.01 * base::kStandardGravity, 1e-9);
  EXPECT_TRUE(tickUntil(gravity, 1002ms, 1101ms).isApprox(kDown, 1e-12));
}

TEST(HandGravity, FollowsAHandThatTurns) {
  HandGravity gravity = known();
  for (int i = 0; i < 1000;
       ++i) {  // at 10 degrees a millisecond would be too fast, at 0.5 it is not
    const Time now = 1200ms + i * 1ms;
    const Vector3d turned = gravityIn(AngleAxisd(5e-3 * i, Vector3d::UnitY()).toRotationMatrix());
    gravity.receive(turned, now);
    EXPECT_TRUE(gravity.tick(now).isApprox(turned, 1e-12));
  }
}

TEST(HandGravity, FadesToZeroWhenNobodySaysItAnyMore) {
  HandGravity gravity = known();  // last told at 1 s
  EXPECT_EQ(tickUntil(gravity, 1201ms, 1500ms), kDown);
  EXPECT_GT(tickUntil(gravity, 1501ms, 1550ms).norm(), 0.4 * base::kStandardGravity);
  EXPECT_TRUE(tickUntil(gravity, 1551ms, 1602ms).isZero(0.0));
}

TEST(HandGravity, AnOldOrientationIsNotBelieved) {
  HandGravity gravity;
  gravity.tick(2s);
  gravity.receive(kDown, 1s);
  EXPECT_TRUE(tickUntil(gravity, 2s, 2200ms).isZero(0.0));
}

TEST(HandGravity, WhatIsNotFiniteOrTooLargeChangesNothing) {
  HandGravity gravity = known();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3d& wrong :
       {Vector3d(nan, 0.0, 0.0), Vector3d(0.0, 0.0, std::numeric_limits<double>::infinity()),
        Vector3d(0.0, 30.0, 0.0)}) {
    gravity.receive(wrong, 1300ms);
    EXPECT_EQ(gravity.tick(1300ms), kDown);
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_hand_gravity
