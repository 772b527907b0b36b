// What the driver says on the console and in rviz of its operating state.
#pragma once

#include <string>

#include "haptex/exoskeleton/control/operating_state.h"

namespace haptex::exoskeleton {

/// The state in one line, why there are no forces in it, and which services to call to get them.
/// @param fault what latched the fault; empty without one
std::string announcement(const OperatingState& state, const std::string& fault);

}  // namespace haptex::exoskeleton
