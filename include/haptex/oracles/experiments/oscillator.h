// An oscillator: a limp cloth on a spring at each particle.
#pragma once

#include "haptex/cloth/dynamics/step.h"

namespace haptex::oracles {

/// What is left of its energy, 1 at the start, where it rests displaced: exact is
/// oscillatorEnergy().
/// @param phase     angular frequency times time_step, > 0
/// @param time_step s, > 0
double simulatedOscillatorEnergy(const cloth::StepSettings& settings, double phase,
                                 double time_step, int steps);

}  // namespace haptex::oracles
