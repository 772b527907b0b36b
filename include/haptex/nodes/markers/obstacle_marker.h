// An obstacle of a scene as rviz marker.
#pragma once

#include <visualization_msgs/Marker.h>

#include "haptex/mesh/obstacle.h"

namespace haptex::nodes {

/// In the namespace "obstacles", with the pose at time 0.
visualization_msgs::Marker obstacleMarker(const mesh::Obstacle& obstacle, int id);

/// Where the obstacle is at a simulated time (s).
void setObstaclePose(const mesh::Obstacle& obstacle, double time,
                     visualization_msgs::Marker& marker);

}  // namespace haptex::nodes
