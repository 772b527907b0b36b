// States of static equilibrium of a cloth, found by its own integrator.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::kes {

/// Backward Euler whose steps are solved to rounding, by factorisation.
/// @param newton_tolerance StepSettings::newton_tolerance
cloth::StepSettings solvedSettings(double newton_tolerance);

/// Backward Euler from rest in every step: inertia over a long step is far below the stiffness, so
/// that a fixed point of the steps is a static equilibrium whatever the step.
class Equilibrium {
 public:
  explicit Equilibrium(const cloth::Cloth& cloth);

  /// Moves the state to an equilibrium, with velocities of zero. Its free particles' forces are
  /// below 1e-9 of the largest force that holds an attached one, or of rounding.
  /// @param cloth      that of the constructor; as in Integrator::step() it may have changed
  /// @param first_step s, > 0; the steps double up to a minute. Short at first where the way is
  ///   long.
  /// @throws std::runtime_error if there is none after 60 steps
  void settle(const cloth::Cloth& cloth, cloth::ClothState& state, double first_step);

  /// Of the cloth in the equilibrium last found (N): Cloth::computeForces().
  const std::vector<Eigen::Vector3d>& forces() const { return forces_; }

 private:
  bool isBalanced(const cloth::Cloth& cloth) const;

  cloth::Integrator integrator_;
  std::vector<Eigen::Vector3d> forces_;
};

}  // namespace haptex::kes
