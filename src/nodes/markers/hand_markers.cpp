#include "haptex/nodes/markers/hand_markers.h"

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::Marker;

constexpr double kSphereSize = 0.008;     // m
constexpr double kHandleSize = 0.014;     // m, so that it can be grasped around the sphere
constexpr double kFingertipSize = 0.035;  // m, of the arrows
constexpr double kHandSize = 0.1;         // m, of the rings
constexpr double kSkin = 0.011;           // m, from the centre of a fingertip to outside of its cap
constexpr double kArrowShaft = 0.0025;    // m, diameter
constexpr double kArrowHead = 0.006;      // m, diameter
constexpr double kTextAbove = 0.07;       // m, over the back of the hand
constexpr double kTextHeight = 0.008;     // m, of a line

Eigen::Vector3f colour(Finger finger) {
  return finger == Finger::kIndex ? Eigen::Vector3f(0.80F, 0.36F, 0.10F)
                                  : Eigen::Vector3f(0.10F, 0.45F, 0.75F);
}

Marker sphere(const Eigen::Vector3f& colour, double size, float opacity) {
  Marker marker = makeMarker("target", 0, Marker::SPHERE);
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color = colourMessage(colour, opacity);
  return marker;
}

/// Along or about an axis: the control's x axis is turned there.
InteractiveMarkerControl control(int axis, std::uint8_t mode) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  InteractiveMarkerControl control;
  control.name = (mode == InteractiveMarkerControl::MOVE_AXIS ? "move_" : "turn_");
  control.name += kAxes[axis];
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d::Unit(axis));
  control.orientation.w = turn.w();
  control.orientation.x = turn.x();
  control.orientation.y = turn.y();
  control.orientation.z = turn.z();
  control.orientation_mode = InteractiveMarkerControl::INHERIT;
  control.interaction_mode = mode;
  return control;
}

InteractiveMarker interactive(const std::string& name, const std::string& frame, double size) {
  InteractiveMarker marker;
  marker.name = name;
  marker.header.frame_id = frame;  // stamp 0: stays in this frame
  marker.scale = static_cast<float>(size);
  for (int axis = 0; axis < 3; ++axis) {
    marker.controls.push_back(control(axis, InteractiveMarkerControl::MOVE_AXIS));
  }
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray targetMarkers(const exoskeleton::HandPlace& place) {
  visualization_msgs::MarkerArray markers;
  for (const Finger finger : base::kFingers) {
    Marker marker = sphere(colour(finger), kSphereSize, 1.0F);
    marker.header.frame_id = handFrame();
    marker.frame_locked = true;
    marker.ns = base::name(finger);
    marker.pose.position = pointMessage(place.fingertips[finger]);
    markers.markers.push_back(marker);
  }
  return markers;
}

visualization_msgs::MarkerArray forceMarkers(
    const base::PerFinger<exoskeleton::FingerMeasurement>& measured, const ros::Time& stamp) {
  visualization_msgs::MarkerArray markers;
  for (const Finger finger : base::kFingers) {
    Marker marker = makeMarker(base::name(finger), 0, Marker::ARROW);
    marker.header.frame_id = handFrame();
    marker.header.stamp = stamp;
    marker.color = colourMessage(colour(finger));
    marker.scale.x = kArrowShaft;
    marker.scale.y = kArrowHead;
    marker.scale.z = 0.0;  // the head's length is a share of the arrow's
    const Eigen::Vector3d& force = measured[finger].force;
    const double norm = force.norm();
    if (norm >= kMinForce) {
      const Eigen::Vector3d tail = measured[finger].pose.translation() + kSkin / norm * force;
      marker.points = {pointMessage(tail), pointMessage(tail + kForceScale * force)};
    }
    deleteIfEmpty(marker);
    markers.markers.push_back(marker);
  }
  return markers;
}

visualization_msgs::MarkerArray stateMarker(const std::string& text, exoskeleton::Mode mode,
                                            const ros::Time& stamp) {
  Marker marker = makeMarker("state", 0, Marker::TEXT_VIEW_FACING);
  marker.header.frame_id = handFrame();
  marker.header.stamp = stamp;
  marker.frame_locked = true;
  marker.pose.position.z = kTextAbove;
  marker.scale.z = kTextHeight;
  marker.text = text;
  const bool fault = mode == exoskeleton::Mode::kFault;
  const bool enabled = mode == exoskeleton::Mode::kEnabled;
  marker.color = colourMessage(fault     ? Eigen::Vector3f(0.80F, 0.05F, 0.10F)
                               : enabled ? Eigen::Vector3f(0.05F, 0.45F, 0.15F)
                                         : Eigen::Vector3f(0.55F, 0.35F, 0.0F));
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(marker);
  return markers;
}

InteractiveMarker fingertipMarker(Finger finger, const exoskeleton::HandPlace& place) {
  InteractiveMarker marker = interactive(base::name(finger), handFrame(), kFingertipSize);
  marker.pose.position = pointMessage(place.fingertips[finger]);
  marker.pose.orientation.w = 1.0;
  InteractiveMarkerControl handle;
  handle.name = "move";
  handle.interaction_mode = InteractiveMarkerControl::MOVE_PLANE;
  handle.orientation_mode = InteractiveMarkerControl::VIEW_FACING;
  handle.orientation.w = 1.0;
  handle.always_visible = true;
  handle.markers.push_back(sphere(colour(finger), kHandleSize, 0.4F));
  handle.markers.back().header.frame_id.clear();  // then its pose is relative to the marker's
  marker.controls.push_back(handle);
  return marker;
}

InteractiveMarker handMarker(const exoskeleton::HandPlace& place) {
  InteractiveMarker marker = interactive(kHandMarker, fixedFrame(), kHandSize);
  marker.pose = poseMessage(place.hand_base);
  for (int axis = 0; axis < 3; ++axis) {
    marker.controls.push_back(control(axis, InteractiveMarkerControl::ROTATE_AXIS));
  }
  return marker;
}

}  // namespace haptex::nodes
