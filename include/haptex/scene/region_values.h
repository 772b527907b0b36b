// Regions of a cloth that are of other fabrics, as scene files say it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::scene {

/// Reads the key `regions`: gives the triangles of the scene's mesh their fabrics.
/// Of a sheet a region has the cells whose middles lie within, so that its edges are moved to the
/// nearest edges of cells.
/// @param file   with the key
/// @param fabric_path of the cloth's own fabric @param groups of the mesh, from its file
/// @return the paths of fabrics 1, 2, ...
/// @throws std::invalid_argument naming file, key, value and what is allowed: no region, a region
///   of the cloth's own fabric, without a triangle, beyond the sheet, or with a triangle of another
///   region; an unknown fabric or group; more than kMostRegions; what modelled effects do not know
///   regions, if effects have it
std::vector<std::string> readRegions(const base::YamlValue& file, const std::string& fabric_path,
                                     const cloth::ModelledEffects& effects,
                                     const mesh::MeshGroups& groups, mesh::ClothMesh& mesh);

constexpr std::size_t kMostRegions = mesh::kMostFabrics - 1;  ///< beside the fabric of the rest

}  // namespace haptex::scene
