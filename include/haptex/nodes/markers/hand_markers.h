// The targets of the emulated person's hand and fingers, and the forces that the fingers feel, as
// rviz markers.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/emulator/hand_path.h"

namespace haptex::nodes {

/// The fingers' targets as small spheres in hand_base.
visualization_msgs::MarkerArray targetMarkers(const exoskeleton::HandPlace& place);

/// Length of the arrow of a force (m/N), so that 0.05 N are seen, and below which force (N) there
/// is none: of a length near 0 it would have no direction.
constexpr double kForceScale = 0.05;
constexpr double kMinForce = 0.01;

/// The measured forces as arrows from the skin of the fingertips, in hand_base: rviz draws a
/// WrenchStamped in hand_base at the origin of hand_base.
/// @param stamp when they were measured
visualization_msgs::MarkerArray forceMarkers(
    const base::PerFinger<exoskeleton::FingerMeasurement>& measured, const ros::Time& stamp);

/// The operating state and why there is no force, as text above the hand: red for a fault, green if
/// forces are rendered.
visualization_msgs::MarkerArray stateMarker(const std::string& text, exoskeleton::Mode mode,
                                            const ros::Time& stamp);

/// Name of the interactive marker of the hand; that of a fingertip is the name of the finger.
constexpr char kHandMarker[] = "hand_base";

/// Can be dragged, along the axes of hand_base and in the plane of the screen.
visualization_msgs::InteractiveMarker fingertipMarker(base::Finger finger,
                                                      const exoskeleton::HandPlace& place);

constexpr char kPinchMarker[] = "pinch";

/// Where its handle is: before the fingertips, m, in hand_base.
Eigen::Vector3d pinchPlace(const base::PerFinger<Eigen::Vector3d>& fingertips);

/// Can be dragged along x of hand_base: towards the hand both fingertips close.
visualization_msgs::InteractiveMarker pinchMarker(const exoskeleton::HandPlace& place);

/// Can be dragged along and turned about the axes of hand_base.
visualization_msgs::InteractiveMarker handMarker(const exoskeleton::HandPlace& place);

}  // namespace haptex::nodes
