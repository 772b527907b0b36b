// Which panels intersect each other or a body.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::garment {

/// Numbers of pairs of triangles that intersect, by the panels that they are of, the smaller index
/// first; the body counts as the panel after the last. Exact (proximity::intersect()). What the
/// body does to itself is not looked at.
/// @param cloth of panels, by its initial positions, m, each proximity::isPlace()
/// @param vertices, triangles of the body, m
std::map<std::array<int, 2>, int> findOverlaps(const mesh::ClothMesh& cloth,
                                               const std::vector<Eigen::Vector3d>& vertices,
                                               const std::vector<std::array<int, 3>>& triangles);

}  // namespace haptex::garment
