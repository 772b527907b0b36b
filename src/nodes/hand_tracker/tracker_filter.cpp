#include "haptex/nodes/hand_tracker/tracker_filter.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Time;
using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Of a stamp that jitters; two poses may not lie closer in time.
constexpr double kShortest = 1e-3;  // s

bool isNear(const Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= TrackerFilter::kFarthest;
}

void requireNow(const ros::Time& stamp, const ros::Time& now) {
  const Time age = between(stamp, now);
  if (age <= TrackerFilter::kOldest && age >= -TrackerFilter::kNewest) return;
  std::ostringstream text;
  text << "header.stamp is " << base::milliseconds(age) << " ms before the clock here: allowed are "
       << base::milliseconds(-TrackerFilter::kNewest) << " to "
       << base::milliseconds(TrackerFilter::kOldest) << " ms";
  throw std::invalid_argument(text.str());
}

}  // namespace

Isometry3d parseMounting(const std::string& text) {
  std::istringstream in(text);
  double x, y, z, yaw, pitch, roll;
  std::string rest;
  const bool six = (in >> x >> y >> z >> yaw >> pitch >> roll) && !(in >> rest);
  if (!six || !isNear({x, y, z}) || !Vector3d(yaw, pitch, roll).allFinite()) {
    std::ostringstream message;
    message << base::quoted(text) << ": allowed are six finite numbers, x y z (m, up to "
            << TrackerFilter::kFarthest << ") yaw pitch roll (rad)";
    throw std::invalid_argument(message.str());
  }
  return Eigen::Translation3d(x, y, z) * AngleAxisd(yaw, Vector3d::UnitZ()) *
         AngleAxisd(pitch, Vector3d::UnitY()) * AngleAxisd(roll, Vector3d::UnitX());
}

Isometry3d TrackerFilter::receive(const geometry_msgs::PoseStamped& message,
                                  const tf2_ros::Buffer& transforms, const ros::Time& now) {
  const Isometry3d body = fromMessage(message.pose);
  requireNow(message.header.stamp, now);
  const Taken next{transformFrom(message.header, fixedFrame(), transforms) * body * mounting_,
                   message.header.stamp};
  if (!isNear(next.hand.translation())) {
    std::ostringstream text;
    text << "the hand would be at (" << next.hand.translation().transpose() << ") in "
         << fixedFrame() << ": allowed are coordinates up to " << kFarthest << " m";
    throw std::invalid_argument(text.str());
  }
  requireReachable(next);
  last_ = next;
  return next.hand;
}

void TrackerFilter::requireReachable(const Taken& next) const {
  if (!last_) return;
  const Time passed = between(last_->stamp, next.stamp);
  // A tracker that was started anew, or whose clock was set back, is believed after a while, too.
  if (passed > kForgetAfter || passed < -kForgetAfter) return;
  if (passed.count() <= 0) {
    throw std::invalid_argument("header.stamp is not later than that of the pose before");
  }
  const double time = std::max(base::seconds(passed), kShortest);
  const double speed = (next.hand.translation() - last_->hand.translation()).norm() / time;
  const Eigen::Matrix3d turn = last_->hand.linear().transpose() * next.hand.linear();
  const double turning = std::abs(AngleAxisd(turn).angle()) / time;
  if (speed <= kFastest && turning <= kFastestTurning) return;
  std::ostringstream text;
  text << "the hand jumps, as if it moved at " << speed << " m/s and " << turning
       << " rad/s: allowed are " << kFastest << " m/s and " << kFastestTurning << " rad/s";
  throw std::invalid_argument(text.str());
}

}  // namespace haptex::nodes
