// From messages to what drives an array. They come from outside: nothing in them is believed.
#pragma once

#include <haptex/Tactile.h>

#include "haptex/base/finger.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {

/// The largest amplitude that is believed, far beyond what a contactor reaches.
constexpr double kLargestAmplitude = 1000.0;  ///< um

/// @returns m
/// @throws std::invalid_argument naming field, value and what is allowed: another frame than
///   <finger>_tactile, an amplitude that is not finite, negative or above kLargestAmplitude
tactile::ArrayAmplitudes amplitudesIn(base::Finger finger, const haptex::Tactile& message);

}  // namespace haptex::nodes
