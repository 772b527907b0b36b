// Co-rotational linear finite elements on every triangle of a cloth; the equations stand in
// docs/mechanics.md.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/forces/membrane.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Elastic and, if asked for, viscous forces that are linear in the small strain that each element
/// has in a frame turning with it (Etzmuss, Keckeisen and Strasser 2003). The frame is that of the
/// polar decomposition [U V] = R S; the strains are weft S11 - 1, warp S22 - 1, shear 2 S12. The
/// moduli are the slopes of the fabric's curves at zero strain and zero strain rate: what a curve
/// does beyond is not modelled, weft and warp are not coupled.
///
/// The forces are the gradient of the energy A (k0 e0^2 + k1 e1^2 + k2 e2^2) / 2, R times the
/// linear stress and, where that stress and S have other principal axes, a term of the second order
/// in the strain without which they would have a moment.
///
/// Newton iterations hold these strains at the beginning of a stage, as Membrane does. Elements
/// that have collapsed to a line or a point have finite forces.
class Corotational final : public Force {
 public:
  /// @param elements  of restElements()
  /// @param viscosity whether the viscous curves of the fabric act
  Corotational(std::vector<MembraneElement> elements, const material::Fabric& fabric,
               bool viscosity);

  MembraneStrain strain(const MembraneElement& element, const Positions& positions) const;
  /// e* of the past.
  MembraneStrain strain(const MembraneElement& element, const StrainPast& past) const;

  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// The projection to a semidefinite matrix is in closed form; it is exact out of the plane of the
  /// element. In the plane it clamps the moduli to >= 0 and shrinks the terms that couple turning
  /// and straining as far as it must.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  std::size_t heldSize() const override { return elements_.size(); }
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

  /// As Membrane::exactJacobian().
  ElementJacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                                const Velocities& velocities) const;

 private:
  std::vector<MembraneElement> elements_;
  Eigen::Vector3d elastic_;  // N/m: weft, warp, shear
  Eigen::Vector3d viscous_;  // N.s/m; zero if viscosity is not modelled
};

}  // namespace haptex::cloth
