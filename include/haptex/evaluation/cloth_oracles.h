// Parts of validateCloth(), by what they look at.
#pragma once

#include "haptex/evaluation/validation.h"
#include "haptex/material/fabric.h"

namespace haptex::evaluation {

/// Orders of convergence, energy of an oscillator, and losses of a swinging sheet.
void validateIntegrators(const material::Fabric& linear, const material::Fabric& wool,
                         const Sink& sink);

}  // namespace haptex::evaluation
