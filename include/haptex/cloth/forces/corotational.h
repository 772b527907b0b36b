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
/// The functions are those of Membrane, with these strains; positions and velocities are not
/// checked either. Elements that have collapsed to a line or a point have finite forces.
class Corotational {
 public:
  /// @param elements of the membrane, with slots of the matrix that addStep() is to add to
  /// @param viscosity whether the viscous curves of the fabric act
  Corotational(std::vector<MembraneElement> elements, const material::Fabric& fabric,
               bool viscosity);

  MembraneStrain strain(const MembraneElement& element, const Positions& positions) const;

  void addForces(const Positions& positions, const Velocities& velocities,
                 std::vector<Eigen::Vector3d>& forces) const;
  double elasticEnergy(const Positions& positions) const;  ///< J

  /// As Membrane::addStep(). The projection to a semidefinite matrix is in closed form; it is exact
  /// out of the plane of the element. In the plane it clamps the moduli to >= 0 and shrinks the
  /// terms that couple turning and straining as far as it must.
  void addStep(const Positions& positions, const Velocities& velocities, const StageTimes& times,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  /// As Membrane::addNewton().
  void addNewton(const Positions& positions, const std::vector<MembraneStrain>& begin_strains,
                 double h, Membrane::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                 linear::BlockVector& rhs) const;
  double incrementalPotential(const Positions& positions,
                              const std::vector<MembraneStrain>& begin_strains, double h) const;

  std::size_t strainCount() const { return elements_.size(); }
  void computeStrains(const Positions& positions, std::vector<MembraneStrain>& strains) const;
  void computeStrainsBefore(const Positions& positions, const Velocities& velocities,
                            double interval, std::vector<MembraneStrain>& strains) const;

  Membrane::Jacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                                   const Velocities& velocities) const;

 private:
  std::vector<MembraneElement> elements_;
  Eigen::Vector3d elastic_;  // N/m: weft, warp, shear
  Eigen::Vector3d viscous_;  // N.s/m; zero if viscosity is not modelled
};

}  // namespace haptex::cloth
