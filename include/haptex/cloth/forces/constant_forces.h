// Forces that do not depend on where the particles are.
#pragma once

#include <vector>

#include "haptex/cloth/forces/force.h"

namespace haptex::cloth {

/// Gravity, and a user-defined force on every particle. Newton iterations hold the positions at the
/// beginning of a stage, from which their potential counts: far from the origin it would be lost in
/// rounding.
class ConstantForces final : public Force {
 public:
  /// @param masses  of the particles, kg
  /// @param gravity m/s^2
  /// @throws std::invalid_argument if gravity is not finite
  ConstantForces(std::vector<double> masses, const Eigen::Vector3d& gravity);

  /// @param other of as many particles
  void copyUserForces(const ConstantForces& other) { set_ = other.set_; }
  const std::vector<Eigen::Vector3d>& userForces() const { return set_; }  ///< N, one per particle
  /// @param force N, finite, of a particle that exists
  void set(int particle, const Eigen::Vector3d& force);

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  /// Relative to the world origin.
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& /*state*/, JacobianRows& /*rows*/) const override {}
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  std::size_t heldSize() const override { return masses_.size(); }
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

 private:
  Eigen::Vector3d force(std::size_t particle) const {
    return set_[particle] + masses_[particle] * gravity_;
  }

  std::vector<double> masses_;
  Eigen::Vector3d gravity_;
  std::vector<Eigen::Vector3d> set_;  // N, by the user
};

}  // namespace haptex::cloth
