#include "haptex/nodes/exoskeleton_emulator/target_input.h"

#include <visualization_msgs/MarkerArray.h>

#include <stdexcept>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/hand_markers.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;

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
    Eigen::Vector3d target = fromMessage(message.point);
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
    const bool released = feedback->event_type == InteractiveMarkerFeedback::MOUSE_UP;
    dragged_ = released ? std::string() : feedback->marker_name;
    if (released) pinched_.reset();
    grasp_.end();
  }
  if (feedback->event_type != InteractiveMarkerFeedback::POSE_UPDATE) return;
  if (feedback->marker_name == kHandMarker) {
    geometry_msgs::PoseStamped message;
    message.header = feedback->header;
    message.pose = feedback->pose;
    receivePose(message);
    return;
  }
  if (feedback->marker_name == kPinchMarker) {
    count_.count(kPinchMarker, [&] { receivePinch(feedback->pose.position); });
    return;
  }
  geometry_msgs::PointStamped message;
  message.header = feedback->header;
  message.point = feedback->pose.position;
  for (const Finger finger : kFingers) {
    if (feedback->marker_name == base::name(finger)) receivePoint(finger, message);
  }
}

/// Towards the hand the fingertips close by twice the way of the handle, each by once.
void TargetInput::receivePinch(const geometry_msgs::Point& handle) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!pinched_) pinched_.emplace(pinchPlace(fingertips_), fingertips_);
  const auto& [begin, fingertips] = *pinched_;
  const double way = begin.x() - fromMessage(handle).x();
  moveFingertips(Grasp::atDistance(Grasp::distanceOf(fingertips) - 2.0 * way, fingertips));
}

void TargetInput::moveFingertips(const Grasp::Fingertips& targets) {
  for (const Finger finger : kFingers) motion_.receive(finger, targets[finger]);
}

void TargetInput::moveOn(double duration, const exoskeleton::HandPlace& place) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fingertips_ = place.fingertips;
  if (const auto targets = grasp_.after(duration, fingertips_)) moveFingertips(*targets);
}

std::string TargetInput::grasp(bool close) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (close) {
    grasp_.close(fingertips_);
    return "the fingertips close";
  }
  if (!grasp_.open()) {
    throw std::invalid_argument(
        "data = false: the fingertips have not been closed by this service");
  }
  return "the fingertips open";
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
  move(pinchMarker(place));
  move(handMarker(place));
  interactive_->applyChanges();
}

}  // namespace haptex::nodes
