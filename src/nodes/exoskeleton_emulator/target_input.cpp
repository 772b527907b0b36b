#include "haptex/nodes/exoskeleton_emulator/target_input.h"

#include <visualization_msgs/MarkerArray.h>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/markers/hand_markers.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;

Eigen::Vector3d vector(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

}  // namespace

TargetInput::TargetInput(const ros::NodeHandle& node, exoskeleton::HandMotion& motion, bool markers)
    : node_(node), motion_(motion), transform_listener_(transforms_) {
  if (markers) {
    interactive_ = std::make_unique<interactive_markers::InteractiveMarkerServer>(
        node_.resolveName("emulator/interactive_markers"));
  }
  marker_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("emulator/target_markers", 2);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  for (const Finger finger : kFingers) {
    const boost::function<void(const geometry_msgs::PointStamped&)> callback =
        [this, finger](const geometry_msgs::PointStamped& message) {
          receivePoint(finger, message);
        };
    point_subscribers_[finger] = node_.subscribe<geometry_msgs::PointStamped>(
        base::name(finger) + std::string("/target"), 1, callback, ros::VoidConstPtr(), hints);
  }
  const boost::function<void(const geometry_msgs::PoseStamped&)> callback =
      [this](const geometry_msgs::PoseStamped& message) { receivePose(message); };
  pose_subscriber_ = node_.subscribe<geometry_msgs::PoseStamped>("hand_base/target", 1, callback,
                                                                 ros::VoidConstPtr(), hints);
}

void TargetInput::receivePoint(Finger finger, const geometry_msgs::PointStamped& message) {
  count_.count(base::name(finger) + std::string("/target"), [&] {
    Eigen::Vector3d target = vector(message.point);
    if (target.allFinite() && message.header.frame_id != handFrame()) {
      target = transformFrom(message.header, handFrame(), transforms_) * target;
    }
    motion_.receive(finger, target);
  });
}

void TargetInput::receivePose(const geometry_msgs::PoseStamped& message) {
  count_.count("hand_base/target", [&] {
    requireFixedFrame(message.header);
    motion_.receive(fromMessage(message.pose));
  });
}

void TargetInput::receiveFeedback(const Feedback& feedback) {
  using visualization_msgs::InteractiveMarkerFeedback;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    dragged_ = feedback->event_type == InteractiveMarkerFeedback::MOUSE_UP ? std::string()
                                                                           : feedback->marker_name;
  }
  if (feedback->event_type != InteractiveMarkerFeedback::POSE_UPDATE) return;
  if (feedback->marker_name == kHandMarker) {
    geometry_msgs::PoseStamped message;
    message.header = feedback->header;
    message.pose = feedback->pose;
    receivePose(message);
    return;
  }
  geometry_msgs::PointStamped message;
  message.header = feedback->header;
  message.point = feedback->pose.position;
  for (const Finger finger : kFingers) {
    if (feedback->marker_name == base::name(finger)) receivePoint(finger, message);
  }
}

void TargetInput::show(const exoskeleton::HandPlace& place) {
  if (marker_publisher_.getNumSubscribers() > 0) marker_publisher_.publish(targetMarkers(place));
  if (interactive_) moveInteractiveMarkers(place);
}

/// All but the one in the person's hand follow the path.
void TargetInput::moveInteractiveMarkers(const exoskeleton::HandPlace& place) {
  std::string dragged;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    dragged = dragged_;
  }
  const auto move = [&](const visualization_msgs::InteractiveMarker& marker) {
    if (marker.name == dragged) return;
    if (!interactive_->setPose(marker.name, marker.pose)) {
      interactive_->insert(marker, [this](const Feedback& feedback) { receiveFeedback(feedback); });
    }
  };
  for (const Finger finger : kFingers) move(fingertipMarker(finger, place));
  move(handMarker(place));
  interactive_->applyChanges();
}

}  // namespace haptex::nodes
