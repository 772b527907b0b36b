// Discrete-orientation polytopes: volumes bounded by planes with fixed normals.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace haptex::proximity {

/// How many planes. Their normals come in opposite pairs: along the 3 coordinate axes (faces of a
/// cube), the 4 diagonals of a cube (its corners), the 6 diagonals of its faces (its edges).
enum class KdopKind {
  k6,   ///< faces: an axis-aligned box
  k14,  ///< faces and corners
  k18,  ///< faces and edges
  k26,  ///< all
};

/// One normal of each pair, with components -1, 0 and 1, not normalised.
const std::vector<Eigen::Vector3d>& kdopAxes(KdopKind kind);

/// All points x with normal . x <= height.
struct HalfSpace {
  Eigen::Vector3d normal;  ///< not normalised
  double height;           ///< m times the length of the normal
};

/// Pairs of opposite half-spaces, in the order of kdopAxes().
using Kdop = std::vector<HalfSpace>;

/// The faces of a volume as convex polygons, counter-clockwise seen from outside, for drawing.
/// Faces smaller than `resolution` are left out.
/// @param resolution m, > 0: corners closer together than this are one
std::vector<std::vector<Eigen::Vector3d>> polytopeFaces(const Kdop& kdop, double resolution);

}  // namespace haptex::proximity
