// How good the triangles of a mesh are.
#pragma once

#include <array>
#include <functional>

#include "haptex/mesh/mesh.h"

namespace haptex::garment {

/// In rest coordinates.
struct TriangleQuality {
  double area = 0.0;         ///< m^2, of all; triangles that turn clockwise count negative
  double least_angle = 0.0;  ///< rad
  int clockwise = 0;         ///< triangles
  int not_delaunay = 0;      ///< edges whose triangles lie in each other's circles, exactly
  double mean = 0.0, spread = 0.0, shortest = 0.0, longest = 0.0;  ///< m, of edges
};

/// @param mesh sound @param counts triangles, by their particles, whose angles count
TriangleQuality qualityOf(
    const mesh::ClothMesh& mesh, const std::function<bool(const std::array<int, 3>&)>& counts =
                                     [](const auto&) { return true; });

}  // namespace haptex::garment
