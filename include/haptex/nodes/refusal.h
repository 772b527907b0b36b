// How a node ends that cannot do what it is asked to, or has nothing to do.
#pragma once

#include <exception>

namespace haptex::nodes {

/// Says why, as a fatal error. With the parameter ~stay, which launch files set for nodes that they
/// respawn after a crash, it waits for the shutdown then: what was refused would be refused again.
/// @returns the exit status
int refuseToRun(const char* node, const std::exception& why);

}  // namespace haptex::nodes
