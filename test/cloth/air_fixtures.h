// Winds, and cloth that only the air acts on.
#pragma once

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

constexpr AirCoefficients kWithLift{1.17, 0.3, 1.57};
constexpr AirCoefficients kWithoutLift{1.17, 0.3, 0.0};

inline Air gusty(const AirCoefficients& coefficients) {
  Air air;
  air.coefficients = coefficients;
  air.wind.mean = {2.0, -1.0, 0.5};
  air.wind.gusts = {{{0.3, 0.2, 0.1}, 3.0, 0.4}, {{0.0, -0.5, 0.2}, 0.7, 0.0}};
  return air;
}

inline Air still(const AirCoefficients& coefficients) {
  Air air;
  air.coefficients = coefficients;
  return air;
}

inline ModelledEffects effectsOf(const Air& air) {
  ModelledEffects effects;
  effects.air = air;
  return effects;
}

/// Without any stress, so that only the air acts.
inline material::Fabric limpFabric() {
  material::Fabric fabric;
  fabric.name = "limp";
  fabric.areal_density = 0.1;
  return fabric;
}

}  // namespace haptex::cloth
