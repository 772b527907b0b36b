// What holds a garment closed while it comes to rest.
#pragma once

#include <vector>

#include "haptex/cloth/forces/fasteners/fasteners.h"
#include "haptex/garment/pattern/pattern.h"
#include "haptex/mesh/mesh.h"

namespace haptex::dressing {

/// Springs between the places that a garment fastens, which nothing opens.
/// @param mesh of the garment, whose panels are the pattern's: sewn or not
/// @param stiffness N/m, > 0
/// @throws std::invalid_argument if the triangles of a panel leave a place out, as they may beside
///   a curve of its outline
std::vector<cloth::Fastener> fastened(const garment::Pattern& pattern, const mesh::ClothMesh& mesh,
                                      double stiffness);

}  // namespace haptex::dressing
