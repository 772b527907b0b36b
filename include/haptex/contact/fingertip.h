// The fingertips that touch the cloth: rigid spheres with pose and velocity.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "haptex/base/finger.h"

namespace haptex::contact {

struct Fingertip {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the centre, world frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< its frame to world frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< m/s, world frame
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       ///< rad/s, world frame
  double radius = 0.0;                                              ///< m, > 0
};

/// Those that are there.
using Fingertips = base::PerFinger<std::optional<Fingertip>>;

/// Where the fingertip will be after `seconds` if it keeps its velocities.
Fingertip predict(const Fingertip& fingertip, double seconds);

/// @throws std::invalid_argument naming what is not finite, not a unit quaternion to 1e-3, or out
///   of range: the radius must be > 0 and at most 0.1 m
void requireSound(const Fingertip& fingertip);
/// Whether requireSound() accepts the fingertip. Allocates nothing.
bool isSound(const Fingertip& fingertip);

}  // namespace haptex::contact
