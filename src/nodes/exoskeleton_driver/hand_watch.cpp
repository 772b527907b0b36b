#include "haptex/nodes/exoskeleton_driver/hand_watch.h"

#include <sstream>

#include "haptex/exoskeleton/control/hand_gravity.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/ros_time.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {
namespace {

using base::Time;
using diagnostic_msgs::DiagnosticStatus;
using exoskeleton::HandGravity;

constexpr double kLookPeriod = 0.01;  // s

std::string noTransform() {
  return std::string("tf does not connect ") + handFrame() + " with " + fixedFrame();
}

}  // namespace

HandWatch::HandWatch(const ros::NodeHandle& node, exoskeleton::DriverLoop& loop)
    : node_(node),
      loop_(loop),
      transform_listener_(transforms_, node_, false),
      trouble_(noTransform()) {
  timer_ = node_.createSteadyTimer(ros::WallDuration(kLookPeriod),
                                   [this](const ros::SteadyTimerEvent&) { look(); });
}

void HandWatch::look() {
  std::optional<Eigen::Isometry3d> hand;
  std::string trouble = noTransform();
  const std::lock_guard<std::mutex> lock(mutex_);  // one thread at a time tells the loop
  if (transforms_.canTransform(fixedFrame(), handFrame(), ros::Time(0))) {
    try {
      const auto transform = transforms_.lookupTransform(fixedFrame(), handFrame(), ros::Time(0));
      const ros::Time& stamp = transform.header.stamp;
      // That of a fixed mounting holds for ever, and one ahead of the clock here holds now.
      const Time age = ageOf(stamp);
      const Eigen::Isometry3d pose = fromMessage(transform.transform);
      if (!pose.matrix().allFinite()) {
        trouble = "the tf of the hand is not finite";
      } else if (age > HandGravity::kTimeout) {
        std::ostringstream text;
        text << "the tf of the hand is " << base::seconds(age) << " s old, allowed are "
             << base::seconds(HandGravity::kTimeout) << " s";
        trouble = text.str();
      } else {
        hand = pose;
        loop_.setGravity(exoskeleton::gravityIn(pose.linear()), realtime::steadyNow() - age);
      }
    } catch (const tf2::TransformException& error) {
      trouble = error.what();  // replaced between the two calls: the next look finds it
    }
  }
  hand_ = hand;
  trouble_ = hand ? "" : trouble;
}

std::optional<Eigen::Isometry3d> HandWatch::hand() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return hand_;
}

void HandWatch::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const Eigen::Vector3d gravity = loop_.status().gravity;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (hand_) {
    status.summary(DiagnosticStatus::OK, "held by feed-forward where forces are rendered");
  } else {
    status.summary(DiagnosticStatus::WARN,
                   "not held by feed-forward, the force sensors have to correct it: " + trouble_);
  }
  std::ostringstream text;
  text << gravity.transpose();
  status.add("gravity in hand_base (m/s^2)", text.str());
}

}  // namespace haptex::nodes
