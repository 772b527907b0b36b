// Forces and Jacobians of a cloth against central differences.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// Expects forces (N) to be the negative gradient of an energy (J) of states, by the places of all
/// particles, as central differences over a step (m) each way tell it.
/// @param tolerance of the largest force
template <typename Energy>
void expectGradient(const std::vector<Eigen::Vector3d>& forces, ClothState state,
                    const Energy& energy, double step, double tolerance) {
  double scale = 0.0;
  for (const Eigen::Vector3d& force : forces) scale = std::max(scale, force.norm());
  ASSERT_GT(scale, 0.0);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      double& number = state.positions[i][axis];
      const double middle = number;
      number = middle + step;
      const double above = energy(state);
      number = middle - step;
      const double below = energy(state);
      number = middle;
      EXPECT_NEAR(forces[i][axis], (below - above) / (2.0 * step), tolerance * scale) << i;
    }
  }
}

/// Expects the forces to be the negative gradient of the energy and the Jacobian that of the
/// forces, by the places of some particles. For cells of 25 mm: errors of the differences near
/// 1e-9.
inline void expectExactDerivatives(const Cloth& cloth, ClothState state,
                                   const std::vector<int>& particles) {
  std::vector<Eigen::Vector3d> forces, above, below;
  cloth.computeForces(state, forces);
  std::vector<int> all;
  double scale = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    all.push_back(static_cast<int>(i));
    scale = std::max(scale, forces[i].norm());
  }
  const std::vector<JacobianBlock> blocks = cloth.jacobian(state, all);
  double stiffness = 0.0;
  for (const JacobianBlock& block : blocks) {
    stiffness = std::max(stiffness, block.by_position.norm());
  }
  constexpr double kStep = 1e-7;  // m
  for (int particle : particles) {
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = state.positions[particle][axis];
      state.positions[particle][axis] = middle + kStep;
      const double energy = cloth.potentialEnergy(state);
      cloth.computeForces(state, above);
      state.positions[particle][axis] = middle - kStep;
      const double slope = (energy - cloth.potentialEnergy(state)) / (2.0 * kStep);
      cloth.computeForces(state, below);
      state.positions[particle][axis] = middle;
      EXPECT_NEAR(-slope, forces[particle][axis], 1e-6 * scale);
      for (const JacobianBlock& block : blocks) {
        if (block.column != particle) continue;
        const Eigen::Vector3d difference = (above[block.row] - below[block.row]) / (2.0 * kStep);
        EXPECT_LT((difference - block.by_position.col(axis)).norm(), 1e-7 * stiffness);
      }
    }
  }
}

}  // namespace haptex::cloth
