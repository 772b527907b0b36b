// Rigid bodies of a scene, and which elements of a mesh are near them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "haptex/proximity/near_element.h"
#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity {

class KdopHierarchy;
struct VolumeIndex;

/// How far a place is from a surface, and where to.
struct SurfaceDistance {
  double distance;         ///< m, negative inside of a solid
  Eigen::Vector3d normal;  ///< unit, away from the nearest point of the surface, out of a solid
};

/// A rigid body with a pose. Copies share the shape. Distances are found through a bounding volume
/// hierarchy of FCL and are right to 1e-9 m at sizes and places of up to some metres, for
/// degenerate triangles too.
class RigidObstacle {
 public:
  // Lengths are finite and at most kMaxLength, otherwise the factories
  // @throws std::invalid_argument naming the value and what is allowed

  /// Solid.
  /// @param radius m, > 0
  static RigidObstacle sphere(double radius);
  /// Solid.
  /// @param sides m, whole edge lengths, each > 0; centred
  static RigidObstacle box(const Eigen::Vector3d& sides);
  /// Solid: the volume within `radius` of a segment of `length` along z, centred.
  /// @param radius m, > 0 @param length m, >= 0
  static RigidObstacle capsule(double radius, double length);
  /// A surface; closed ones are not filled. Vertices that no triangle has are no part of it.
  /// @throws std::invalid_argument if empty, an index is out of range or a vertex not finite
  static RigidObstacle mesh(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<std::array<int, 3>>& triangles);

  /// From the obstacle's own frame to that of the mesh it is held against; identity at first.
  /// @throws std::invalid_argument naming what is wrong unless it is finite, at most kMaxLength
  ///   away and rigid: no scale, shear or reflection beyond 1e-9
  void setPose(const Eigen::Isometry3d& pose);
  const Eigen::Isometry3d& pose() const { return pose_; }

  /// Largest d . x over the points x of the obstacle, in the frame of the pose (m |d|).
  double support(const Eigen::Vector3d& d) const;
  /// Distance of a triangle with finite corners, and its point nearest to the obstacle. If they
  /// touch or overlap, closer than the rounding of the coordinates, the distance is exactly 0 and
  /// the point is any that they have in common. Does not allocate.
  TrianglePoint closestPoint(const Triangle& triangle) const;
  /// Distance of a finite place to the surface. Where several points are nearest, or the place is
  /// on a mesh, the normal is any of those that there are; a mesh has no inside. Does not allocate.
  SurfaceDistance distance(const Eigen::Vector3d& place) const;
  /// Radius of a ball around the origin of the obstacle's frame that holds the obstacle (m).
  double boundingRadius() const;

 private:
  struct Shape;
  explicit RigidObstacle(std::shared_ptr<const Shape> shape);

  std::shared_ptr<const Shape> shape_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
};

/// The elements of a mesh near an obstacle, like KdopHierarchy::query() for a cursor.
void query(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle, const Range& range,
           std::vector<NearElement>& found);
/// The volumes that it tests, like KdopHierarchy::tested() for a cursor.
std::vector<VolumeIndex> tested(const KdopHierarchy& hierarchy, const RigidObstacle& obstacle,
                                const Range& range);

}  // namespace haptex::proximity
