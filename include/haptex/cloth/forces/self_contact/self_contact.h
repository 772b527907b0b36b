// Contact of a cloth with itself: pressure through its thickness, and friction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/forces/force.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"
#include "haptex/cloth/forces/self_contact/pair_energies.h"

namespace haptex::cloth {

/// The sum of PairEnergies, a function of the positions alone, and Coulomb friction with the
/// fabric's MIU between the points of each pair that are nearest to each other. Friction is smooth:
/// at a slip speed v below kSlipSpeed the coefficient is MIU times (2 - v/kSlipSpeed) v/kSlipSpeed,
/// so that what sticks creeps. Newton iterations hold the normal forces, the normals and the
/// weights, and friction is the gradient of a convex potential of the slip since the stage's base
/// (Li et al., Incremental Potential Contact, ACM Trans. Graphics 39(4), 2020).
///
/// Both sums of forces are zero to rounding. The stiffness in matrices is that along the normals
/// alone, which is positive semidefinite; what turns a normal is left out.
///
/// The functions keep what they found last, the result does not depend on it; so one thread at a
/// time may call them. They allocate where more is near than ever before.
class SelfContact final : public Force {
 public:
  static constexpr double kSlipSpeed = 1e-3;  ///< m/s

  /// @param triangles without defects
  /// @param reference positions (m) of the particles in the flat fabric
  /// @throws std::invalid_argument if the fabric has no compression or no friction
  SelfContact(const std::vector<std::array<int, 3>>& triangles,
              const std::vector<Eigen::Vector3d>& reference, const material::Fabric& fabric);

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  /// By differences of the forces, right to some 1e-6 of the stiffest blocks.
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  /// Keeps what it holds itself, because pairs come and go.
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

  /// What touches at these positions; empty where one of them is not finite.
  const std::vector<PairEnergy>& touching(const Positions& positions) const;
  NearPairs& nearPairs() const { return near_; }
  const LayerLaw& law() const { return energies_.law(); }

 private:
  /// Of a pair, while Newton iterations hold it.
  struct HeldFriction {
    int count;
    std::array<int, 4> vertices;
    std::array<double, 4> weights;
    Eigen::Vector3d normal;
    double most;            // N, friction of what slips
    Eigen::Vector3d start;  // m, sum of weights times positions at the stage's base
  };

  void addEnergies(const Positions& positions, double a, linear::SymmetricBlockMatrix& matrix,
                   linear::BlockVector& rhs) const;

  double friction_;
  mutable NearPairs near_;
  mutable PairEnergies energies_;
  mutable Positions touching_at_;
  mutable std::vector<PairEnergy> touching_;
  mutable std::vector<HeldFriction> held_;
};

}  // namespace haptex::cloth
