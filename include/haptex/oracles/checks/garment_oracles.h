// Parts of validateGarment(), by what they look at.
#pragma once

#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {

/// Panels that are sewn along straight and curved lines and darts, by ties and merged: uniform
/// stress across the seam, gaps, mass and momentum.
void validateSeams(const Sink& sink);

/// Discs with a sector cut out and sewn.
void validateCones(const Sink& sink);

/// Strips with a seam against those in one piece: length under their weight, period, and energy of
/// bending.
void validateSewnStrips(const Sink& sink);

}  // namespace haptex::oracles
