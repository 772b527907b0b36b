// How far a point gets towards a rigid obstacle within a step.
#pragma once

#include <Eigen/Core>

#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// A straight path in the frame of an obstacle.
struct Path {
  const Eigen::Vector3d& begin;  ///< m
  const Eigen::Vector3d& end;    ///< m
};

/// How far along a path, from 0 to 1, something is nearer to the surface than a clearance > 0 (m);
/// 2 if nowhere. Steps are as long as the distance allows (sphere tracing), and at least a quarter
/// of the clearance, which does not lead through a surface, or 1e-5 of the path if that is more.
double firstTouch(const proximity::RigidObstacle& shape, const Path& path, double clearance);

/// Where a path ends that slides along the tangent plane from where it touches (m).
Eigen::Vector3d slidingEnd(const proximity::RigidObstacle& shape, const Path& path, double touch);

}  // namespace haptex::contact
