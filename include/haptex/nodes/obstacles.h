// From the obstacles of a scene to those that proximity queries are asked about.
#pragma once

#include "haptex/cloth/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::nodes {

/// The same shape with the same pose: its frame is then the world frame.
/// @throws std::invalid_argument what the factories of RigidObstacle and setPose() say
proximity::RigidObstacle makeObstacle(const cloth::Obstacle& obstacle);

}  // namespace haptex::nodes
