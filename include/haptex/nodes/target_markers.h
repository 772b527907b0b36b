// The targets of the emulated person's hand and fingers as rviz markers.
#pragma once

#include <visualization_msgs/InteractiveMarker.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/hand_path.h"

namespace haptex::nodes {

/// The fingers' targets as small spheres in hand_base.
visualization_msgs::MarkerArray targetMarkers(const exoskeleton::HandPlace& place);

/// Name of the interactive marker of the hand; that of a fingertip is the name of the finger.
constexpr char kHandMarker[] = "hand_base";

/// Can be dragged, along the axes of hand_base and in the plane of the screen.
visualization_msgs::InteractiveMarker fingertipMarker(exoskeleton::Finger finger,
                                                      const exoskeleton::HandPlace& place);

/// Can be dragged along and turned about the axes of hand_base.
visualization_msgs::InteractiveMarker handMarker(const exoskeleton::HandPlace& place);

}  // namespace haptex::nodes
