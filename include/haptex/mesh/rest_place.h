// Where rest coordinates are in a mesh.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

struct RestPlace {
  int triangle;
  Eigen::Vector3d weights;  ///< barycentric, of its corners: each >= 0, sum 1
};

/// The first of some triangles that has a place, its border included (to 1e-9 of its size); none if
/// no one has.
/// @param mesh without defects @param triangles of it
/// @param rest (u along weft, v along warp), m, in the axes of the triangles' panel
std::optional<RestPlace> findRestPlace(const ClothMesh& mesh, const std::vector<int>& triangles,
                                       const Eigen::Vector2d& rest);

/// Of all triangles.
std::optional<RestPlace> findRestPlace(const ClothMesh& mesh, const Eigen::Vector2d& rest);

}  // namespace haptex::mesh
