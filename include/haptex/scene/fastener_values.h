// Fasteners of a cloth, as scene files say it.
#pragma once

#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/forces/fasteners/fasteners.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::scene {

/// Reads the key `fasteners`. A place by rest coordinates is in the triangle that has them, the
/// first one where several do.
/// @param groups of the mesh, from its file
/// @throws std::invalid_argument naming file, key, value and what is allowed: a name that another
///   has, a particle or a group that there is not, rest coordinates that no triangle has, or that
///   are given without a group where the mesh has seams, two places that are the same, a number out
///   of its range, a length that is missing or that a button or hook has
std::vector<cloth::Fastener> readFasteners(const base::YamlValue& value,
                                           const mesh::ClothMesh& mesh,
                                           const mesh::MeshGroups& groups);

/// Whether a scene's fasteners name particles, which another mesh of the same cloth numbers
/// otherwise.
bool nameParticles(const base::YamlValue& fasteners);

}  // namespace haptex::scene
