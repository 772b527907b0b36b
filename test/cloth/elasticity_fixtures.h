// What the tests of the models of stretch and shear share.
#pragma once

#include <algorithm>
#include <vector>

#include "fixtures.h"
#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

inline ModelledEffects effectsOf(Elasticity elasticity, bool viscosity = false,
                                 bool bending = false) {
  ModelledEffects effects;
  effects.elasticity = elasticity;
  effects.viscosity = viscosity;
  effects.bending = bending;
  return effects;
}

/// So rigid that bend springs matter beside the others.
inline material::Fabric fabricWithRigidity() {
  material::Fabric fabric = stiffeningFabric();
  fabric.bending = {2e-4, 1e-4};
  return fabric;
}

inline std::vector<Eigen::Vector3d> forcesOf(const Cloth& cloth, const ClothState& state) {
  std::vector<Eigen::Vector3d> forces;
  cloth.computeForces(state, forces);
  return forces;
}

inline double largest(const std::vector<Eigen::Vector3d>& vectors) {
  double result = 0.0;
  for (const Eigen::Vector3d& vector : vectors) result = std::max(result, vector.norm());
  return result;
}

}  // namespace haptex::cloth
