// Regions of a cloth that are of other fabrics, as scene files say it.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/scene/scene.h"

namespace haptex::scene {

/// Reads the key `regions`: gives the scene's triangles their fabrics, and adds the files of these.
/// Of a sheet a region has the cells whose middles lie within, so that its edges are moved to the
/// nearest edges of cells.
/// @param file   with the key
/// @param groups of the scene's mesh, from its file
/// @throws std::invalid_argument naming file, key, value and what is allowed: no region, a region
///   of the cloth's own fabric, without a triangle, beyond the sheet, or with a triangle of another
///   region; an unknown fabric or group; more than kMostRegions; what modelled effects do not know
///   regions, if effects have it
void readRegions(const base::YamlValue& file, const mesh::MeshGroups& groups, Scene& scene);

constexpr std::size_t kMostRegions = 255;

}  // namespace haptex::scene
