// What an explicit method makes of an oscillation.
#pragma once

#include "haptex/cloth/dynamics/step.h"

namespace haptex::oracles {

/// Largest modulus by which a step of an explicit method multiplies an oscillation y' = i omega y,
/// or x'' = -omega^2 x with two-step Euler.
/// @param phase omega times the time step
/// @throws std::invalid_argument if the method is implicit
double amplification(cloth::IntegrationMethod method, double phase);

}  // namespace haptex::oracles
