// States of a sheet of cloth that are hard on a proximity query.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::oracles {

struct DeformedSheet {
  std::string name;
  std::vector<Eigen::Vector3d> positions;  ///< m, one per particle
};

/// At least 20 states of a sheet, always the same: flat, stretched, sheared, rolled, folded with
/// and without a gap between the layers, pleated, waved, crumpled, twisted, noisy, mirrored, tiny,
/// huge, far from the origin, collapsed to a line and to a point.
/// @param mesh as makeRectangle() makes it
std::vector<DeformedSheet> deformedSheets(const mesh::ClothMesh& mesh);

/// The positions (m) of one of them. "flat" has the rest coordinates (u, v, 0).
/// @throws std::invalid_argument if none has that name
std::vector<Eigen::Vector3d> deformedSheet(const mesh::ClothMesh& mesh, const std::string& name);

}  // namespace haptex::oracles
