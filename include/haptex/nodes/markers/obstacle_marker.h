// An obstacle of a scene as rviz marker.
#pragma once

#include <visualization_msgs/Marker.h>

#include "haptex/mesh/obstacle.h"

namespace haptex::nodes {

/// In the namespace "obstacles", with the pose at time 0. One with mass is striped, which shows how
/// it turns.
visualization_msgs::Marker obstacleMarker(const mesh::Obstacle& obstacle, int id);

}  // namespace haptex::nodes
