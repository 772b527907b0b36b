#include "haptex/simulation/frame_follower.h"

#include <algorithm>

namespace haptex::simulation {
namespace {

using base::seconds;
using base::Time;

Eigen::Quaterniond turnOf(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0.0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

}  // namespace

FrameMotion FrameFollower::extrapolate(Time now) const {
  const Time elapsed = std::clamp(now - *time_, Time{0}, kPeriods * period_);
  FrameMotion motion = last_;
  motion.pose.translation() += seconds(elapsed) * last_.velocity;
  motion.pose.linear() = turnOf(seconds(elapsed) * last_.angular_velocity) * last_.pose.linear();
  if (elapsed < now - *time_) {  // it is not known to move any more
    motion.velocity.setZero();
    motion.angular_velocity.setZero();
  }
  return motion;
}

FrameMotion FrameFollower::at(Time now) const {
  if (!time_) return {};
  FrameMotion motion = extrapolate(now);
  if (period_ == Time{0}) return motion;
  const double progress = seconds(now - blend_begin_) / seconds(period_);
  const double rest = 1.0 - std::clamp(progress, 0.0, 1.0);
  if (rest == 0.0) return motion;
  const double weight = rest * rest;
  motion.pose.translation() += weight * offset_;
  motion.pose.linear() =
      Eigen::AngleAxisd(weight * turn_.angle(), turn_.axis()) * motion.pose.linear();
  return motion;
}

void FrameFollower::receive(const Eigen::Isometry3d& pose, Time time, Time now) {
  const bool is_first = !time_;
  const FrameMotion before = at(now);
  const Time period = is_first ? Time{0} : time - *time_;
  const bool moves_on = period > Time{0} && period <= kLongestPeriod;
  if (moves_on) {
    const double duration = seconds(period);
    const Eigen::AngleAxisd turn(pose.linear() * last_.pose.linear().transpose());
    last_.velocity = (pose.translation() - last_.pose.translation()) / duration;
    last_.angular_velocity = turn.angle() / duration * turn.axis();
  } else {
    last_.velocity.setZero();
    last_.angular_velocity.setZero();
  }
  last_.pose = pose;
  time_ = time;
  if (is_first) return;
  period_ = std::clamp(period, Time{std::chrono::milliseconds(1)}, kLongestPeriod);
  blend_begin_ = now;
  const FrameMotion after = extrapolate(now);
  offset_ = before.pose.translation() - after.pose.translation();
  turn_ = Eigen::AngleAxisd(before.pose.linear() * after.pose.linear().transpose());
}

}  // namespace haptex::simulation
