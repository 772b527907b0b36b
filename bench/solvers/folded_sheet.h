// A sheet of 0.5 m square, folded in half so that its layers lie on one another.
#pragma once

#include <cmath>
#include <vector>

#include "held_sheet.h"

namespace haptex::bench {

/// Flat sheet around a half circle as wide as the fabric is thick, in the plane of x and z.
inline mesh::ClothMesh foldedMesh(int cells, double thickness) {
  constexpr double kSide = 0.5;  // m
  mesh::ClothMesh mesh =
      mesh::makeRectangle(kSide, kSide, cells, cells, mesh::Triangulation::kAlternating);
  const double radius = 0.5 * thickness, arc = M_PI * radius;
  const double straight = 0.5 * (kSide - arc);  // of each layer
  for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
    const double along = mesh.rest_coordinates[i].y();
    Eigen::Vector3d& position = mesh.initial_positions[i];
    if (along < straight) {
      position = {-along, position.y(), 0.0};
    } else if (along > straight + arc) {
      position = {-(kSide - along), position.y(), thickness};
    } else {
      const double angle = (along - straight) / radius;
      position = {-straight - radius * std::sin(angle), position.y(),
                  radius * (1.0 - std::cos(angle))};
    }
  }
  return mesh;
}

/// Its lower layer is held along three edges, the upper one lies on it, and both sag.
/// @param fabric with compression and friction
inline HeldSheet foldedSheet(const material::Fabric& fabric, int cells,
                             const cloth::StepSettings& settings) {
  std::vector<int> held;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells / 2; ++j) {
      if (i == 0 || i == cells || j == 0) held.push_back(j * (cells + 1) + i);
    }
  }
  return {foldedMesh(cells, fabric.compression->thickness), held, fabric, true, settings};
}

}  // namespace haptex::bench
