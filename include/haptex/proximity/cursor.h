// The volumes around a haptic cursor whose neighbourhood is asked for.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

namespace haptex::proximity {

/// Places, radii and distances may not be larger than this (m): far beyond any workspace, but small
/// enough that no sum or square overflows.
constexpr double kMaxLength = 1e9;

/// Whether a place is finite and each coordinate within kMaxLength.
inline bool isPlace(const Eigen::Vector3d& place) {
  return std::abs(place.x()) <= kMaxLength && std::abs(place.y()) <= kMaxLength &&
         std::abs(place.z()) <= kMaxLength;  // false for NaN
}

/// @throws std::invalid_argument naming the place, called `what`, unless isPlace()
void requirePlace(const Eigen::Vector3d& place, const std::string& what);

struct Sphere {
  Eigen::Vector3d centre;  ///< m
  double radius;           ///< m, >= 0
};

/// The volume spanned by two spheres: their convex hull, which is the union of all spheres with
/// centre begin.centre + t (end.centre - begin.centre) and radius
/// begin.radius + t (end.radius - begin.radius), 0 <= t <= 1.
struct TaperedCapsule {
  Sphere begin;
  Sphere end;

  bool isSphere() const { return begin.centre == end.centre && begin.radius == end.radius; }
};

/// A union of volumes, in the frame of the mesh it is held against. Every shape that a cursor may
/// have is a special case of the tapered capsule. The factories
/// @throws std::invalid_argument naming the value unless all numbers are finite and at most
/// kMaxLength, all radii are >= 0 and there is at least one sphere
class Cursor {
 public:
  static Cursor point(const Eigen::Vector3d& place);
  static Cursor spheres(const std::vector<Sphere>& spheres);
  /// The volume within `radius` of the segment between two points.
  static Cursor capsule(const Eigen::Vector3d& begin, const Eigen::Vector3d& end, double radius);
  static Cursor taperedCapsule(const Sphere& begin, const Sphere& end);

  const std::vector<TaperedCapsule>& parts() const { return parts_; }

 private:
  explicit Cursor(std::vector<TaperedCapsule> parts);

  std::vector<TaperedCapsule> parts_;
};

}  // namespace haptex::proximity
