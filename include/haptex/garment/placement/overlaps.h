// Which panels intersect each other or a body.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "haptex/garment/body/body.h"
#include "haptex/garment/triangulation/panel_mesh.h"

namespace haptex::garment {

/// Numbers of pairs of triangles that intersect, by the panels that they are of, the smaller index
/// first; the body counts as the panel after the last. Exact. What the body does to itself is not
/// looked at.
std::map<std::array<int, 2>, int> findOverlaps(const std::vector<PanelMesh>& meshes,
                                               const Body& body);

}  // namespace haptex::garment
