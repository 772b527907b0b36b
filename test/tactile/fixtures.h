// A surface of one wave, and how calls refuse.
#pragma once

#include <string>

#include "../refusal.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/stroke.h"

namespace haptex::tactile {

using oracles::addGrating;
using oracles::direction;
using oracles::flatField;
using oracles::variance;
using oracles::whiteNoise;

/// One wave of amplitude `amplitude` (m) and wave vector `k` (rad/m).
inline SmallScale singleWave(const Eigen::Vector2d& k, double amplitude,
                             double friction_per_slope = 0.0) {
  return {{{k.x()}, {k.y()}, {0.5 * amplitude * amplitude}}, friction_per_slope};
}

}  // namespace haptex::tactile
