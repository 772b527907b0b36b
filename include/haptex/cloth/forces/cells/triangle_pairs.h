// Which triangles of a mesh make quadrilateral cells together.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// Two triangles with a common side as one cell.
struct TrianglePair {
  std::array<int, 2> triangles;
  /// The ends of the common side, then the two corners opposite to it, as the triangles above.
  std::array<int, 4> particles;
  /// Of the particles, along weft and warp of the fabric, m.
  std::array<Eigen::Vector2d, 4> rest;
};

struct PairedTriangles {
  std::vector<TrianglePair> pairs;
  std::vector<int> single;  ///< triangles without a partner, ascending
};

/// How often pairTriangles() looks for partners among those that are left.
constexpr int kPairingRounds = 3;

/// Pairs each two triangles of a fabric that are the best partner of each other, that is, whose
/// quadrilateral is nearest to a rectangle: the sine of its sharpest or bluntest corner is largest,
/// and at least 0.3; then those that are left, kPairingRounds times in all. In a grid of
/// rectangles, however its cells are cut, the cells are found at once. What partner a triangle has
/// follows from those up to 2 kPairingRounds sides away.
/// @param mesh without defects @param fabric whose triangles are paired, within a panel
PairedTriangles pairTriangles(const mesh::ClothMesh& mesh, int fabric);

}  // namespace haptex::cloth
