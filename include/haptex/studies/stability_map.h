// Time step against stiffness: which integrator is stable where.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/step.h"

namespace haptex::studies {

/// What became of the energy of a vibrating sheet.
enum class Stability {
  kKept,      ///< at least half of it was left
  kDamped,    ///< less was
  kDiverged,  ///< it grew fourfold, or a step was not finite
};

const char* nameOf(Stability stability);

struct StabilityCell {
  double time_step;  ///< s
  double stiffness;  ///< N/m
  Stability stability;
  double energy_left;  ///< of the vibration's energy at first, at the end; infinite if diverged
};

/// A sheet of 0.1 kg/m2, 4 x 4 cells of 10 mm, held at all sides and strained by 5 %, vibrates in
/// all its modes at once with amplitudes of a thousandth of a cell, for 50 steps.
/// @param stiffness of weft and warp, shear half of it, N/m
/// @param newton_iterations of the implicit methods
StabilityCell findStability(cloth::IntegrationMethod method, int newton_iterations,
                            double time_step, double stiffness);

/// The sheet's highest angular frequency (rad/s).
double highestFrequency(double stiffness);

/// The longest time step of an explicit method, times the highest angular frequency of the sheet,
/// at which the energy of its highest mode grows less than 1e5-fold in 1000 steps: measured with
/// it, and what the method's amplification of a linear oscillator gives.
struct StabilityLimit {
  double measured;
  double theory;
};
/// @throws std::invalid_argument if the method is implicit
StabilityLimit findStabilityLimit(cloth::IntegrationMethod method, double stiffness);

}  // namespace haptex::studies
