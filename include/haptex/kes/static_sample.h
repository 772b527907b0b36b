// A sample of cloth that goes from one static equilibrium to the next, as testers pull it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/kes/equilibrium.h"

namespace haptex::kes {

/// A vector of the world frame by rest coordinates.
using Field = std::function<Eigen::Vector3d(const Eigen::Vector2d&)>;

class StaticSample {
 public:
  inline static const Eigen::Vector3d kDisturbance{0.0, 2e-5, 2e-5};  ///< m, within the sheet

  /// @param effects as for Cloth; viscosity acts in moveAs() alone
  /// @throws what Cloth throws
  StaticSample(mesh::ClothMesh mesh, const material::Fabric& fabric,
               const cloth::ModelledEffects& effects = {});

  const mesh::ClothMesh& mesh() const { return cloth_.mesh(); }

  /// Holds these particles at `place` of their rest coordinates, moves the others there too but for
  /// a random disturbance, and lets them find the equilibrium.
  /// @param disturbance m, standard deviation along each axis
  /// @throws std::runtime_error if it is not reached
  void equilibrate(const std::vector<int>& held, const Field& place,
                   const Eigen::Vector3d& disturbance = kDisturbance);
  /// Makes it a new sample: at rest, without friction.
  void renew() { state_ = cloth_.initialState(); }
  /// From now on the particles move with these velocities where they are; until equilibrate().
  void moveAs(const Field& velocity);
  const Eigen::Vector3d& position(int particle) const { return state_.positions[particle]; }  ///< m
  /// The force that holds a particle (N).
  Eigen::Vector3d reaction(int particle) const { return -forces_[particle]; }

 private:
  cloth::Cloth cloth_;
  cloth::Cloth moving_;  // the same with viscosity
  cloth::ClothState state_;
  Equilibrium equilibrium_;
  std::vector<Eigen::Vector3d> forces_;
  std::mt19937 random_{1};
};

}  // namespace haptex::kes
