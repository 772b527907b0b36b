// One fabric of several that are glued together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "haptex/material/fabric.h"

namespace haptex::material {

constexpr std::size_t kMostLayers = 8;

/// The fabric that layers are together, glued all over, so that they are strained alike in their
/// planes and bent as one. Areal densities and membrane curves are added, as of springs side by
/// side, thicknesses under equal pressure likewise. Bending is that of a laminate (Jones 1999,
/// Mechanics of Composite Materials, 4.3.2) of layers that are k_i stiff at rest and whose middles
/// are at z_i:
///   D = sum D_i + sum k_i (z_i - z0)^2,  z0 = sum k_i z_i / sum k_i.
/// Its hysteresis is the layers' own, added. The first layer is the face: friction and surface are
/// its. There is no resilience, no hysteresis of shear and no contraction.
/// @param layers from face to back, 2 to kMostLayers, each with bending and compression
/// @throws std::invalid_argument naming the layer and what it lacks, or how many layers there are
Fabric glue(const std::vector<Fabric>& layers, const std::string& name);

}  // namespace haptex::material
