// A strip of linear modulus that hangs under its own weight: exact and simulated.
#pragma once

#include "haptex/material/strain_stress_curve.h"

namespace haptex::oracles {

/// Strip of length L (m), areal density w (kg/m^2) and modulus k (N/m) hanging from its top edge
/// under g (m/s^2).
struct HangingStrip {
  double length;
  double modulus;
  double areal_density;
  double gravity;
};

/// Exact relative elongation. The stretch l at height s above the lower end satisfies
/// l^3 - l = 2 w g s / k; integrating l - 1 over the strip by the stretch l = 1 + q at the top
/// gives
///   k / (2 w g) (q^2 + 2 q^3 + 3/4 q^4) / L.
/// @param strip length, modulus, areal density > 0, gravity >= 0, all finite, so that w g L / k is
///   at most 1e12
/// @throws std::invalid_argument naming what is out of these ranges
double exactElongation(const HangingStrip& strip);

/// Relative elongation of a simulated strip one fifth as wide as long, at rest.
/// @param cells     along the length, a multiple of 5
/// @param time_step s, of backward Euler with one linear solve per step
/// @throws std::invalid_argument if cells is not a positive multiple of 5
double simulatedElongation(const HangingStrip& strip, int cells, double time_step);

/// Stretch l under a load: l s((l^2 - 1) / 2) = load with a curve that rises.
/// @param load N/m, from 0 to that at kLargestStretch
/// @throws std::invalid_argument naming a load out of this range
constexpr double kLargestStretch = 2.0;
double stretchUnder(double load, const material::StrainStressCurve& curve);

}  // namespace haptex::oracles
