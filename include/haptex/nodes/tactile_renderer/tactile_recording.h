// Amplitudes of the tactile array from a bag.
#pragma once

#include <string>

#include "haptex/tactile/contactor_sound.h"

namespace haptex::nodes {

/// Amplitudes of a contactor in the only topic of haptex/Tactile in the bag whose name ends in
/// <finger>/tactile, by the stamps of its messages. As with the array, which falls silent without
/// messages, amplitudes are zero where none came for more than a step and a half.
/// @param contactor index 6 row + column
/// @throws std::runtime_error naming the bag if it cannot be read, std::invalid_argument naming the
///   contactor if there is none, the topics in the bag if none or more than one is meant, the
///   length if it is above kLongestSound
tactile::ContactorSteps recordedSteps(const std::string& bag, const std::string& finger,
                                      int contactor);

}  // namespace haptex::nodes
