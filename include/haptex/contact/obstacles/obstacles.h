// From the obstacles of a scene to those that can be asked what is near them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// The same shape with the pose that it has at a time (s, simulated): its frame is then the world
/// frame.
/// @throws std::invalid_argument what the factories of RigidObstacle and setPose() say
proximity::RigidObstacle makeObstacle(const mesh::Obstacle& obstacle, double time = 0.0);

/// The coefficient of friction of a fabric on an obstacle: the obstacle's own, or the fabric's.
/// @throws std::invalid_argument if neither has one
double frictionOn(const mesh::Obstacle& obstacle, const material::Fabric& fabric);

/// The first of a cloth's triangles that touches an obstacle, or is inside of a solid one; -1:
/// none.
/// @param places m, of the particles, finite, in the frame of the obstacle's pose
int firstTouching(const std::vector<std::array<int, 3>>& triangles,
                  const std::vector<Eigen::Vector3d>& places,
                  const proximity::RigidObstacle& obstacle);

}  // namespace haptex::contact
