// The mass-spring lattice: structural, shear and bend springs between the particles of a
// rectangular mesh, with the curves of a fabric; the equations stand in docs/mechanics.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/lattice_springs.h"
#include "haptex/cloth/forces/membrane.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Springs to the next neighbours (structural), across the cells (shear) and over two cells (bend;
/// Provot 1995), with stresses s(e) per Green-Lagrange strain e of a spring such that a sheet
/// delivers the fabric's curves where a lattice can:
///   shear       (s = c fs(c e)) both diagonals of a sheared cell, whose sides keep their length,
///               together give the fabric's shear curve;
///   structural  (s = fu(e) - what the diagonals add) a sheet that is stretched along weft or warp
///               and held across gives the fabric's tensile force;
///   bend        (s = k e for e < 0, else 0) a fold by a right angle costs what the rigidity asks.
/// What a lattice cannot do: the diagonals couple weft and warp; a fold by the angle a costs
/// 2 sin^2(a/2) of what it should, so that slight curvature meets no resistance.
///
/// Newton iterations hold the strains at the beginning of a stage, as Membrane does: those of
/// springs 3 t, 3 t + 1 and 3 t + 2 in the vector t.
class SpringLattice final : public Force {
 public:
  /// @param viscosity whether the viscous curves of the fabric act, combined as the elastic ones
  /// @param bend      whether there are bend springs; every fabric must then have a rigidity
  /// @throws std::invalid_argument as findLatticeSprings()
  SpringLattice(const mesh::ClothMesh& mesh, const material::Fabric& fabric, bool viscosity,
                bool bend);

  const std::vector<LatticeSpring>& springs() const { return springs_; }
  /// Of every spring.
  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// The block of each spring is projected exactly: across a compressed spring its stiffness is 0,
  /// along it at least 0.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  std::size_t heldSize() const override { return (springs_.size() + 2) / 3; }
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

  /// Derivatives of the force on the first particle by its own position and velocity: those by the
  /// second's are the negative, and the force on the second is the opposite.
  struct Jacobian {
    Eigen::Matrix3d by_position;  ///< N/m
    Eigen::Matrix3d by_velocity;  ///< N.s/m
  };
  Jacobian exactJacobian(const LatticeSpring& spring, const Positions& positions,
                         const Velocities& velocities) const;

 private:
  struct Law {
    std::array<material::StrainStressCurve, 3> curves;  // weft, warp, shear
    std::array<double, 2> rigidity = {0.0, 0.0};        // N.m, weft, warp
    material::CurveValue respond(const LatticeSpring& spring, double strain) const;
    double energy(const LatticeSpring& spring, double strain) const;  // J/m^2
  };

  std::vector<LatticeSpring> springs_;
  Law elastic_;
  Law viscous_;
  bool viscosity_;
};

}  // namespace haptex::cloth
