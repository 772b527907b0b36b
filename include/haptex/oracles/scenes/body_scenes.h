// Obstacles with mass, where exact results are known.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/oracles/scenes/obstacle_scenes.h"

namespace haptex::oracles {

/// A sphere with mass (kg, m, m/s), friction 0.3 of the cloth on it.
/// @param friction of it on other obstacles
mesh::Obstacle ballOf(double mass, double radius, const Eigen::Vector3d& place,
                      const Eigen::Vector3d& velocity, double friction = 0.3);

/// Obstacles far from a small sheet. @param gravity m/s^2, along -z
CollidingCloth bodiesAlone(std::vector<mesh::Obstacle> obstacles, double gravity);

/// Acceleration (m/s^2) of a body that is laid on an incline at rest, down the incline, in the
/// second quarter of a second.
/// @param half_height m, of its middle above the incline @param angle rad
double accelerationDown(mesh::Obstacle body, double half_height, double angle);

}  // namespace haptex::oracles
