// States that no motion leads to.
#pragma once

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/studies/extreme_case.h"

namespace haptex::studies {

/// Moves the free particles, or gives them velocities, as the kind of the case says: a push,
/// scrambled, collapsed, mirrored, elements without area, or fast.
void disturbState(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
                  cloth::ClothState& state);

}  // namespace haptex::studies
