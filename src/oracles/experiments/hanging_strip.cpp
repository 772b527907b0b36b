#include "haptex/oracles/experiments/hanging_strip.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "haptex/base/require.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/linear_fabric.h"

namespace haptex::oracles {

using cloth::Cloth;
using cloth::Integrator;
using material::StrainStressCurve;

double exactElongation(const HangingStrip& strip) {
  constexpr double kMostLoad = 1e12;
  const auto require_positive = [](const char* name, double value, bool zero_too) {
    base::require(std::isfinite(value) && (value > 0.0 || (zero_too && value == 0.0)),
                  "exactElongation", name, value, zero_too ? "finite and >= 0" : "finite and > 0");
  };
  require_positive("length", strip.length, false);
  require_positive("modulus", strip.modulus, false);
  require_positive("areal_density", strip.areal_density, false);
  require_positive("gravity", strip.gravity, true);
  const double load = strip.areal_density * strip.gravity / strip.modulus * strip.length;
  base::require(load <= kMostLoad, "exactElongation", "weight over modulus", load, "<= 1e12");
  const double right = 2.0 * load;
  // Newton on 2 q + 3 q^2 + q^3 = right, convex from above.
  double q = std::min(0.5 * right, std::cbrt(right));
  for (int i = 0; i < 50; ++i) {
    q -= (q * (2.0 + q * (3.0 + q)) - right) / (2.0 + q * (6.0 + 3.0 * q));
  }
  // q^2 (1 + 2 q + 3/4 q^2) / right, which is 0 / 0 without a load.
  return q * (1.0 + q * (2.0 + 0.75 * q)) / (2.0 + q * (3.0 + q));
}

double simulatedElongation(const HangingStrip& strip, int cells, double time_step) {
  if (cells <= 0 || cells % 5 != 0) {
    throw std::invalid_argument("cells is " + std::to_string(cells) +
                                "; it must be a positive multiple of 5");
  }
  // Viscosity near the critical damping of the slowest longitudinal mode: it shortens the way to
  // the state of rest and does not change it.
  const double slowest = 0.5 * M_PI / strip.length * std::sqrt(strip.modulus / strip.areal_density);
  material::Fabric fabric = material::linearFabric(strip.modulus, strip.modulus / slowest);
  fabric.areal_density = strip.areal_density;

  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -strip.gravity};
  Cloth cloth(mesh::makeRectangle(strip.length / 5.0, strip.length, cells / 5, cells,
                                  mesh::Triangulation::kAlternating),
              fabric, effects);
  cloth::ClothState state = cloth.initialState();
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth::AttachmentPath place;
    place.start = state.positions[particle];
    cloth.attach(particle, place);
  }
  Integrator integrator(cloth, {});
  constexpr double kTimeConstants = 30.0;  // e^-30 is below rounding
  while (state.time * slowest < kTimeConstants || state.time < 10.0 * time_step) {
    integrator.step(cloth, state, time_step);
  }
  const std::vector<int> bottom = sideParticles(cloth.mesh(), mesh::Side::kBottom);
  double lower_end = 0.0;
  for (int particle : bottom) lower_end += state.positions[particle].z() / bottom.size();
  return -lower_end / strip.length - 1.0;
}

double stretchUnder(double load, const StrainStressCurve& curve) {
  const auto load_at = [&](double l) { return l * curve.evaluate(0.5 * (l * l - 1.0)).stress; };
  const double most = load_at(kLargestStretch);
  base::require(load >= 0.0 && load <= most, "stretchUnder", "load", load,
                ">= 0 and <= " + base::shortNumber(most) + " N/m");
  double low = 1.0, high = kLargestStretch;
  for (int halving = 0; halving < 60; ++halving) {
    const double l = 0.5 * (low + high);
    (load_at(l) < load ? low : high) = l;
  }
  return low;
}

}  // namespace haptex::oracles
