// From the obstacles of a scene to those that can be asked what is near them.
#pragma once

#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// The same shape with the pose that it has at time 0: its frame is then the world frame.
/// @throws std::invalid_argument what the factories of RigidObstacle and setPose() say
proximity::RigidObstacle makeObstacle(const mesh::Obstacle& obstacle);

}  // namespace haptex::contact
