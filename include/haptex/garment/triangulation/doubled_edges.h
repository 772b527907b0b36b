// Edges that panels would have twice once they are sewn.
#pragma once

#include <vector>

#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/mesh/seam.h"

namespace haptex::garment {

/// Where two panels are sewn to each other along edges that meet in a corner, as a lining is to its
/// shell at hem and front, both may have an inner edge between the same two particles, and a
/// triangle in the corner. Sewn, these would be an edge of four triangles and two triangles that
/// are one, which no mesh may have. Such an edge of the later panel is cut in its middle, and its
/// two triangles from there to their opposite corners.
/// @param seams particles as joined() numbers those of the panels
void splitDoubledEdges(const std::vector<mesh::Seam>& seams, std::vector<PanelMesh>& panels);

}  // namespace haptex::garment
