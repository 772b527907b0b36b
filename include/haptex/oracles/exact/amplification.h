// What the methods of integration make of an oscillation.
#pragma once

#include "haptex/cloth/dynamics/step.h"

namespace haptex::oracles {

/// Largest modulus by which a step of an explicit method multiplies an oscillation y' = i omega y,
/// or x'' = -omega^2 x with two-step Euler.
/// @param phase omega times the time step, finite and >= 0
/// @throws std::invalid_argument if the method is implicit, or naming a phase out of this range
double amplification(cloth::IntegrationMethod method, double phase);

/// By which factor the amplitude of an undamped oscillation grows or shrinks in a step of any
/// method, the implicit ones solved exactly: the square root of what its energy is multiplied by.
/// The amplitude of BDF-2 is that after its first steps, when its second root has died away; that
/// of two-step Euler the mean over a period up to a phase of 2, beyond which it grows.
/// @param phase omega times the time step, finite and >= 0
/// @throws std::invalid_argument naming a phase out of this range
double growthPerStep(cloth::IntegrationMethod method, double phase);

/// What a number of steps leaves of the energy of an undamped oscillator that starts at rest,
/// displaced: by the recurrence of the method itself, its start included. BDF-2 starts with
/// TR-BDF2.
/// @param phase as above @param steps >= 0
/// @throws std::invalid_argument naming what is out of these ranges
double oscillatorEnergy(cloth::IntegrationMethod method, double phase, int steps);

}  // namespace haptex::oracles
