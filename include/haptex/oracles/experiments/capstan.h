// A strip that is pulled over a fixed cylinder, and what friction on it does to its tension.
#pragma once

#include <string>

#include "haptex/base/repeatable_random.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/material/fabric.h"

namespace haptex::oracles {

/// A strip of two cells' width that lies around a fixed capsule, both ends straight on, without
/// gravity. A dead load along weft pulls at one end, the other one is drawn off with a constant
/// speed. It starts with the tension that it has when it slips everywhere.
struct CapstanCase {
  material::Fabric fabric;   ///< its bending is not modelled
  double friction = 0.3;     ///< Coulomb's coefficient
  double wrap = 3.14159265;  ///< rad, > 0
  double speed = 0.02;       ///< m/s, of the end that is drawn off, > 0
  double cell = 2.5e-3;      ///< m, sides of the cells
  double radius = 0.02;      ///< m, of the middle of the fabric around the capsule
  double strain = 0.01;      ///< along weft at the end that is drawn off, if mechanics is right
  double time_step = 0.0125;
  int steps = 500;  ///< that are measured, after half as many that are not
  int threads = 1;  ///< of 1 to 64
  int solves = 2;   ///< StepSettings::newton_iterations
  cloth::IntegrationMethod method = cloth::IntegrationMethod::kBackwardEuler;
};

struct CapstanOutcome {
  double ratio;     ///< mean tension over the dead load, both less what the motion takes
  double exact;     ///< exp(friction wrap)
  double total;     ///< the largest sum of |T| over friction times the sum of N, in any step
  double particle;  ///< the largest |T| over friction N of a particle, in any step
  double pull;      ///< N, the largest -N of a particle, in any step; 0 if none pulled
  double rounds;    ///< mean number of solves that looked for what touches, per step
  double seconds;   ///< computing time per step
  double contacts;  ///< mean number of contacts that held
};

/// The capstan equation with inertia, (T1 - m v^2) / (T0 - m v^2) = exp(mu phi).
/// @throws std::runtime_error if a step was not accepted
CapstanOutcome pullOverCapstan(const CapstanCase& capstan);

/// A radius (m) against which the cells are small, a twelfth at most: polygons of such sides differ
/// from circles by less than 0.4 % of the ratio for mu <= 0.7 and two half turns.
double capstanRadius(double cell);

/// Friction 0.1 to 0.7, wrap 90 to 360 degrees, steps of 1 to 12.5 ms, 1 to 100 mm/s, cells of 1 to
/// 10 mm; fabrics linear with 100 to 16 448 N/m, which is wool's initial slope along warp, or wool
/// drawn along weft or warp.
/// @param config_directory with fabrics/wool.yaml
CapstanCase drawCapstan(const std::string& config_directory, base::RepeatableRandom& random);

}  // namespace haptex::oracles
