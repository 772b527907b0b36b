// How a sheet resists stretch and shear if nobody says.
#pragma once

#include "haptex/cloth/forces/modelled_effects.h"

namespace haptex::scene {

/// Elasticity::kBilinear where the cloth bends, and what else is modelled knows it; otherwise
/// kGreenLagrange. Cells that do not bend would zigzag, and cost more than triangles there
/// (docs/mechanics.md, Locking).
/// @param effects of a sheet of rectangular cells; its elasticity does not count
cloth::Elasticity usualElasticity(const cloth::ModelledEffects& effects);

}  // namespace haptex::scene
