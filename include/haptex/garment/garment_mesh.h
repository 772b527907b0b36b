// A garment as one mesh of panels, and what is to be sewn to what.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/pattern/pattern.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/seam.h"

namespace haptex::garment {

struct GarmentMesh {
  /// All panels, one after the other, as they lie before they are sewn (m, world frame), with no
  /// particle in common. `panels` are those of the pattern, in its order.
  mesh::ClothMesh mesh;
  std::vector<mesh::Seam> seams;     ///< of the pattern, in its order
  std::vector<std::string> fabrics;  ///< names; Panel::fabric counts them
  std::vector<std::string> panel_names;
};

/// Triangulates all panels (triangulate()). Both sides of a seam are divided alike: where one has a
/// corner the other has a particle, and between corners both have as many even parts as the one
/// that needs more. So sides that differ in length by their easing have as many particles, unless
/// an edge is in several seams, or a panel is so narrow there that refine() had to halve its
/// outline.
/// @param edge_length m, at most so long are edges along the outline, and about so long the others
/// @throws std::invalid_argument if a panel is to be laid on a carrier, and what triangulate() says
GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length);

}  // namespace haptex::garment
