// The surface of a cloth without stress, as contact of the cloth with itself needs it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// Of a sheet, or of panels that are sewn together. Lengths and areas are those of each triangle in
/// its own panel.
struct RestSurface {
  /// @param mesh without defects
  explicit RestSurface(const mesh::ClothMesh& mesh);

  /// m, of the triangles; infinite if there is none.
  double shortestAltitude() const;
  /// m^2, of a triangle.
  double area(std::size_t triangle) const;
  /// m, of the particles: of one panel in its plane, of several the initial ones. Neighbours lie
  /// beside each other in both.
  const std::vector<Eigen::Vector3d>& places() const { return places_; }
  /// Whether places() are the flat fabric.
  bool isFlat() const { return flat_; }

  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<Eigen::Vector3d, 3>> corners;  ///< m, of each triangle, in a plane
  std::vector<int> fabrics;  ///< of the triangles; empty: all of fabric 0

 private:
  std::vector<Eigen::Vector3d> places_;
  bool flat_;
};

}  // namespace haptex::cloth
