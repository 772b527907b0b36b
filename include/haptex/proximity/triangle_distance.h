// Distances between a triangle and a point, or the volume spanned by two spheres.
#pragma once

#include <Eigen/Core>
#include <array>

#include "haptex/proximity/cursor.h"

namespace haptex::proximity {

using Triangle = std::array<Eigen::Vector3d, 3>;  ///< corners, m

/// A point of a triangle and how far it is.
struct TrianglePoint {
  double distance;              ///< m, see the function that computed it
  Eigen::Vector3d barycentric;  ///< weights of the corners, each in [0, 1], their sum 1

  Eigen::Vector3d on(const Triangle& triangle) const {
    return barycentric[0] * triangle[0] + barycentric[1] * triangle[1] +
           barycentric[2] * triangle[2];
  }
};

/// The point of a triangle closest to a place, after Ericson, Real-Time Collision Detection (2005),
/// 5.1.5. Where the triangle is thin, its three edges are compared instead of trusting the signs
/// that the regions are told by, so that triangles without area are as good as any.
TrianglePoint closestPoint(const Triangle& triangle, const Eigen::Vector3d& place);

/// The point x of a triangle with the smallest signed distance to a tapered capsule,
///   min over 0 <= t <= 1 of |x - c(t)| - r(t):
/// outside the distance to the surface, inside the negative distance to it. The function is convex
/// in (x, t), so the best of its minima over corners, edges and interior is the answer.
TrianglePoint closestPoint(const Triangle& triangle, const TaperedCapsule& capsule);

/// Unit normal of the triangle, counter-clockwise corners seen from its tip; zero if the triangle
/// has no area.
Eigen::Vector3d unitNormal(const Triangle& triangle);

}  // namespace haptex::proximity
