// What acts inside of a patch, but for gravity and contact.
#pragma once

#include <array>
#include <vector>

#include "haptex/cloth/forces/force_sum.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/contact/refined_cut.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::contact {

struct PatchForces {
  cloth::ForceSum sum;
  /// Of particles that act on each other without sharing a triangle; first < second.
  std::vector<std::array<int, 2>> pairs;
};

/// Membrane, bending and air on the particles of a cut. Refined elements bend as fine as they are.
/// Those around them bend by their corners, together with the corners of the refined ones, which
/// resist nothing there: so both are as regular as the mesh is, and where its cells are rectangles
/// hinges of four particles are exact (cloth::BendingModel::kLinear). Along the line between both
/// some half of a coarse cell resists no bend across it. Panels that are merged bend each by
/// itself, and over their seams by the hinges of cloth::SeamBending, as the large-scale cloth does.
/// @param coarse  the mesh that was cut
/// @param fabrics with bending
/// @throws std::invalid_argument as cloth::Membrane, cloth::Bending and cloth::Aerodynamics
PatchForces forcesOn(const mesh::ClothMesh& coarse, const RefinedCut& cut,
                     const std::vector<material::Fabric>& fabrics,
                     const cloth::ModelledEffects& effects);

}  // namespace haptex::contact
