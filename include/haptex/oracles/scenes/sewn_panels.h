// Two panels that fit together in the plane, to be sewn.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/mesh/seam.h"

namespace haptex::oracles {

enum class SeamShape {
  kStraight,
  kCurved,  ///< both edges follow one polyline, whose corners are the left edge's particles
  kDart,  ///< one panel: the right side is turned by the dart's angle about its tip, at the border
};

/// A rectangle of 0.16 x 0.1 m that is cut from its lower to its upper edge.
struct SewnPanels {
  static constexpr double kWidth = 0.16, kHeight = 0.1;  ///< m
  static constexpr double kDartAngle = 0.3;              ///< rad

  mesh::ClothMesh mesh;               ///< not sewn; initial positions are flat and rest shapes
  mesh::Seam seam;                    ///< upwards, the left edge first
  std::vector<Eigen::Vector2d> flat;  ///< m, where the particles are when it is sewn and flat
  int left_triangles = 0;             ///< come first
  std::array<int, 2> beside_ends{};   ///< the right panel's next ones on the border
  std::vector<int> border;            ///< those of the rectangle, which every seam ends in
};

/// @param left, right places of the particles along the seam, ascending from 0 to 1, at least two
/// @param seed of the irregular triangles inside
SewnPanels sewnPanels(SeamShape shape, const std::vector<double>& left,
                      const std::vector<double>& right, unsigned seed);

/// The largest distance (m) of a particle of the edge that has more of them, or the second, from
/// its place on the other edge.
/// @param seam with places
double seamGap(const mesh::Seam& seam, const std::vector<Eigen::Vector3d>& positions);

/// Places at equal distances. @param count at least 2
std::vector<double> evenPlaces(int count);
/// The same with as many more in the middles between the first ones as asked for, less than count.
std::vector<double> nestedPlaces(int count, int more);

}  // namespace haptex::oracles
