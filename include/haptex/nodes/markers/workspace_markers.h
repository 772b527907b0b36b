// The workspace of the hand and what the fingertips reach of it, as rviz markers.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

namespace haptex::nodes {

/// The edges of the workspace in world, and in hand_base the surface of the places that each
/// fingertip reaches. With stamp 0: they stay in their frames.
/// @param urdf text of the exoskeleton's URDF
/// @throws std::invalid_argument as exoskeleton::FingerKinematics
visualization_msgs::MarkerArray workspaceMarkers(const std::string& urdf);

}  // namespace haptex::nodes
