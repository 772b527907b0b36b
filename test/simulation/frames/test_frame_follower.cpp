#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "haptex/simulation/frame_follower.h"

namespace haptex::simulation::test_frame_follower {
namespace {

using base::seconds;
using base::Time;
using namespace std::chrono_literals;

constexpr Time kTick = 1ms;
constexpr Time kPeriod = 10ms;  // of exoskeleton_emulator

/// A hand that swings 50 mm to both sides and turns by 0.5 rad, once per second.
Eigen::Isometry3d swing(Time time) {
  const double phase = 2.0 * M_PI * seconds(time);
  return Eigen::Translation3d(0.05 * std::sin(phase), 0.1, -0.2) *
         Eigen::AngleAxisd(0.5 * std::sin(phase), Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0);
}

double angleBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

TEST(FrameFollower, IsTheIdentityAtRestBeforeThereIsAPose) {
  const FrameMotion motion = FrameFollower().at(1s);
  EXPECT_TRUE(motion.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0));
  EXPECT_EQ(motion.velocity.norm(), 0.0);
}

TEST(FrameFollower, RestsAtASinglePose) {
  FrameFollower follower;
  follower.receive(swing(100ms), 1s, 1s);
  for (const Time now : {Time{1s}, Time{1005ms}, Time{2s}}) {
    EXPECT_TRUE(follower.at(now).pose.isApprox(swing(100ms), 1e-15));
    EXPECT_EQ(follower.at(now).velocity.norm(), 0.0);
    EXPECT_EQ(follower.at(now).angular_velocity.norm(), 0.0);
  }
}

TEST(FrameFollower, IsExactForAUniformMotion) {
  FrameFollower follower;
  const Eigen::Vector3d velocity(0.1, -0.2, 0.05);
  const Eigen::Vector3d turning = 0.3 * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
  const auto at = [&](Time time) {
    return Eigen::Translation3d(seconds(time) * velocity) *
           Eigen::AngleAxisd(seconds(time) * 0.3, turning.normalized());
  };
  for (Time now = 1s; now < 1200ms; now += kTick) {
    if (now % kPeriod == 0ms) follower.receive(Eigen::Isometry3d(at(now)), now, now);
    if (now < 1050ms) continue;  // until the blend of the first step is over
    const FrameMotion motion = follower.at(now);
    EXPECT_TRUE(motion.pose.isApprox(Eigen::Isometry3d(at(now)), 1e-12));
    EXPECT_LT((motion.velocity - velocity).norm(), 1e-10);
    EXPECT_LT((motion.angular_velocity - turning).norm(), 1e-6);  // AngleAxis of a small turn
  }
}

TEST(FrameFollower, FollowsWithoutSteps) {
  FrameFollower follower;
  double largest_step = 0.0, largest_turn = 0.0, largest_error = 0.0, largest_told = 0.0;
  Eigen::Isometry3d before = swing(1s), told = swing(1s);
  for (Time now = 1s; now < 3s; now += kTick) {
    if (now % kPeriod == 0ms) {
      follower.receive(swing(now), now, now);
      largest_told = std::max(largest_told, (swing(now).translation() - told.translation()).norm());
      told = swing(now);
    }
    const Eigen::Isometry3d pose = follower.at(now).pose;
    if (now > 1050ms) {
      largest_step = std::max(largest_step, (pose.translation() - before.translation()).norm());
      largest_turn = std::max(largest_turn, angleBetween(before, pose));
      largest_error =
          std::max(largest_error, (pose.translation() - swing(now).translation()).norm());
    }
    before = pose;
  }
  // The fastest is 0.05 m 2 pi / s = 0.314 mm per tick, and 3.14 mrad. An error e of the
  // extrapolation, at most 1.5 a T^2 = 1.5 x 1.97 m/s^2 x (10 ms)^2 = 0.3 mm, is blended out with
  // 2 e / 10 ticks; the velocity of the last period is off by half of a T.
  EXPECT_LT(largest_step, 0.314e-3 + 2.0 * 0.3e-3 / 10.0);
  EXPECT_LT(largest_turn, 3.14e-3 + 2.0 * 3.0e-3 / 10.0);
  EXPECT_LT(largest_error, 0.35e-3);
  EXPECT_GT(largest_told, 3e-3) << "what the follower is for";
}

TEST(FrameFollower, DoesNotStepWhenAPoseComesLate) {
  FrameFollower follower;
  Eigen::Isometry3d before = swing(1s);
  double largest_step = 0.0;
  for (Time now = 1s; now < 3s; now += kTick) {
    if (now % kPeriod == 3ms) follower.receive(swing(now - 3ms), now - 3ms, now);
    const Eigen::Isometry3d pose = follower.at(now).pose;
    if (now > 1050ms) {
      largest_step = std::max(largest_step, (pose.translation() - before.translation()).norm());
    }
    before = pose;
  }
  EXPECT_LT(largest_step, 0.314e-3 + 2.0 * 0.4e-3 / 10.0);
}

TEST(FrameFollower, StopsWhereItIsWhenNoMorePosesCome) {
  FrameFollower follower;
  for (Time now = 1s; now <= 1100ms; now += kPeriod) follower.receive(swing(now), now, now);
  const Eigen::Isometry3d stopped = follower.at(1100ms + FrameFollower::kPeriods * kPeriod).pose;
  const FrameMotion later = follower.at(2s);
  EXPECT_TRUE(later.pose.isApprox(stopped, 1e-12));
  EXPECT_EQ(later.velocity.norm(), 0.0);
  EXPECT_EQ(later.angular_velocity.norm(), 0.0);
}

TEST(FrameFollower, DoesNotFlyOffAfterAPauseOrARepeatedStamp) {
  FrameFollower follower;
  follower.receive(swing(1s), 1s, 1s);
  follower.receive(swing(1100ms), 1s, 1001ms);  // the same time, another place
  EXPECT_EQ(follower.at(1002ms).velocity.norm(), 0.0);
  follower.receive(swing(1500ms), 1500ms, 1500ms);
  EXPECT_EQ(follower.at(1501ms).velocity.norm(), 0.0);
  EXPECT_TRUE(follower.at(2s).pose.isApprox(swing(1500ms), 1e-12));
}

}  // namespace
}  // namespace haptex::simulation::test_frame_follower
