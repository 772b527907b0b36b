// Rigid bodies of a scene, and which elements of a mesh are near them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "haptex/proximity/kdop_hierarchy.h"
#include "haptex/proximity/near_element.h"

namespace haptex::proximity {

/// A rigid body with a pose; distances through FCL.
class RigidObstacle {
 public:
  /// @param radius m, > 0
  static RigidObstacle sphere(double radius);
  /// @param sides m, whole edge lengths, each > 0; centred
  static RigidObstacle box(const Eigen::Vector3d& sides);
  /// The volume within `radius` of a segment of `length` along z, centred.
  /// @param radius m, > 0 @param length m, >= 0
  static RigidObstacle capsule(double radius, double length);
  /// A surface; closed ones are not filled.
  /// @throws std::invalid_argument if empty, an index is out of range or a vertex not finite
  static RigidObstacle mesh(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<std::array<int, 3>>& triangles);

  /// From the obstacle's own frame to that of the mesh it is held against.
  void setPose(const Eigen::Isometry3d& pose);
  const Eigen::Isometry3d& pose() const;

  /// Largest d . x over the points x of the obstacle, in the frame of the pose (m |d|).
  double support(const Eigen::Vector3d& d) const;
  /// Distance of a triangle, 0 if they touch or overlap, and its point nearest to the obstacle.
  TrianglePoint closestPoint(const Triangle& triangle) const;
};

/// The elements of a mesh near an obstacle, like KdopHierarchy::query() for a cursor.
void query(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle, const Range& range,
           std::vector<NearElement>& found);

}  // namespace haptex::proximity
