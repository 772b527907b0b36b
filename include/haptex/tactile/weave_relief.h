// Reliefs of woven fabrics from the parameters of their weave.
#pragma once

#include "haptex/material/surface.h"
#include "haptex/tactile/amplitude_map.h"
#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// A piece of the relief with whole repeats of the weave, a few millimetres long and wide, sampled
/// at about 0.1 mm: it continues at its opposite edge. The crowns vary by the weave's irregularity,
/// the same way at every call.
/// @throws std::invalid_argument naming a parameter out of range: spacings of 0.2 to 3 mm, heights
///   >= 0 of which one is > 0, irregularity 0 to 0.5
HeightField weaveRelief(const material::Weave& weave);

/// How the amplitudes of the same fabric vary over some tens of square centimetres because its
/// yarns do along their length. Mean square 1; uniform without irregularity.
/// @throws as weaveRelief()
AmplitudeMap weaveUnevenness(const material::Weave& weave);

}  // namespace haptex::tactile
