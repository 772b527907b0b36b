#include "haptex/nodes/force_renderer/fingertip_filter.h"

#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Time;

void requireHandFrame(const std_msgs::Header& header) {
  if (header.frame_id == handFrame()) return;
  throw std::invalid_argument("header.frame_id = " + base::quoted(header.frame_id) +
                              ": allowed is '" + handFrame() + "'");
}

void requireNow(const std_msgs::Header& header, const ros::Time& now) {
  const Time age = between(header.stamp, now);
  constexpr Time kTolerance = FingertipFilter::kStampTolerance;
  if (age <= kTolerance && age >= -kTolerance) return;
  std::ostringstream text;
  text << "header.stamp is " << base::milliseconds(age) << " ms before the clock here: allowed are "
       << base::milliseconds(-kTolerance) << " to " << base::milliseconds(kTolerance) << " ms";
  throw std::invalid_argument(text.str());
}

void requireWithin(const char* what, const Eigen::Vector3d& vector, double largest,
                   const char* unit) {
  if (vector.allFinite() && vector.cwiseAbs().maxCoeff() <= largest) return;
  std::ostringstream text;
  text << what << " = (" << vector.transpose() << "): allowed are finite numbers up to " << largest
       << " " << unit;
  throw std::invalid_argument(text.str());
}

Eigen::Isometry3d soundPose(const geometry_msgs::Pose& message) {
  const Eigen::Isometry3d pose = fromMessage(message);
  requireWithin("the position", pose.translation(), FingertipFilter::kFarthest, "m");
  return pose;
}

simulation::FingertipTwist soundTwist(const geometry_msgs::Twist& message) {
  const simulation::FingertipTwist twist{fromMessage(message.linear), fromMessage(message.angular)};
  requireWithin("the velocity", twist.velocity, FingertipFilter::kFastest, "m/s");
  requireWithin("the angular velocity", twist.angular_velocity, FingertipFilter::kFastestTurning,
                "rad/s");
  return twist;
}

}  // namespace

template <typename Value, typename Message, typename Convert>
std::optional<Value> FingertipFilter::receive(const char* topic, const Message& message,
                                              const ros::Time& now, Time steady_now, Last& last,
                                              const Convert& convert) {
  try {
    requireHandFrame(message.header);
    const Value value = convert();
    requireNow(message.header, now);
    const bool remembered = last.time && steady_now - *last.time <= kForgetAfter;
    if (remembered && between(last.stamp, message.header.stamp).count() <= 0) {
      throw std::invalid_argument("header.stamp is not later than that of the message before");
    }
    last = {message.header.stamp, steady_now};
    return value;
  } catch (const std::invalid_argument& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++dropped_;
    last_drop_ = std::string(topic) + ": " + error.what();
    return std::nullopt;
  }
}

std::optional<Eigen::Isometry3d> FingertipFilter::receive(const geometry_msgs::PoseStamped& message,
                                                          const ros::Time& now, Time steady_now) {
  return receive<Eigen::Isometry3d>("measured_cp", message, now, steady_now, last_pose_,
                                    [&] { return soundPose(message.pose); });
}

std::optional<simulation::FingertipTwist> FingertipFilter::receive(
    const geometry_msgs::TwistStamped& message, const ros::Time& now, Time steady_now) {
  return receive<simulation::FingertipTwist>("measured_cv", message, now, steady_now, last_twist_,
                                             [&] { return soundTwist(message.twist); });
}

std::optional<simulation::FingertipMotion> FingertipFilter::receive(
    const haptex::Fingertips& message, base::Finger finger, const ros::Time& now, Time steady_now) {
  const auto i = static_cast<std::size_t>(finger);
  return receive<
      simulation::
          FingertipMotion>("exoskeleton/fingertips", message, now, steady_now, last_motion_, [&] {
    return simulation::FingertipMotion{soundPose(message.poses[i]), soundTwist(message.twists[i])};
  });
}

std::uint64_t FingertipFilter::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

std::string FingertipFilter::lastDrop() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_drop_;
}

}  // namespace haptex::nodes
