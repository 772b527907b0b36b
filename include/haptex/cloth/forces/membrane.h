// The Green-Lagrange membrane element of Volino and Magnenat-Thalmann 2005 on every triangle of a
// cloth; the equations stand in docs/mechanics.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/cloth/forces/membrane_kernel.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// Elastic and, if asked for, viscous membrane forces of all elements of a mesh. Newton iterations
/// hold the strains e0 at the beginning of a stage, one vector per element; their incremental
/// potential is
///   sum_elements A [W(e) + a G((e - e0) / a)],  G the integral of the viscous curves,
/// whose discrete strain rate is exactly zero under rigid motion.
class Membrane final : public Force {
 public:
  /// @param elements    of restElements()
  /// @param viscosity   whether the viscous curves of the fabric act
  /// @param contraction whether its transverse contraction does: suu += c evv, svv += c euu with
  ///   c of material::contractionModulus()
  Membrane(std::vector<MembraneElement> elements, const material::Fabric& fabric, bool viscosity,
           bool contraction = false);

  const std::vector<MembraneElement>& elements() const { return elements_; }

  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  /// F_i = -A [suu ru_i U + svv rv_i V + suv (ru_i V + rv_i U)].
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// With the exact projection: slopes of the curves clamped to >= 0, those of weft and warp
  /// together with the contraction by projectStress(), as the stress of the geometric part is; the
  /// same K on both sides.
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

  /// The exact Jacobians of the forces of one element: blocks [i][j] are dF_i/dP_j (N/m) and
  /// dF_i/dv_j (N.s/m) of its particles in the order of `particles`. With viscosity dF/dP is not
  /// symmetric, because the strain rate depends on the position.
  ElementJacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                                const Velocities& velocities) const;

 private:
  using Curves = std::array<material::StrainStressCurve, 3>;  // weft, warp, shear
  struct Frame;                                               // U, V of an element, or their rates
  struct Response;                                            // stress and slopes
  static Frame frame(const MembraneElement& element, const std::vector<Eigen::Vector3d>& points);
  static MembraneStrain rateIn(const MembraneElement& element, const ForceState& state,
                               const Frame& at);
  template <bool kViscous>
  void assembleElement(const MembraneElement& element, const Positions& positions,
                       const Velocities& velocities, const StageTimes& times,
                       linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  static Response respond(const Curves& curves, const MembraneStrain& strain);
  Response respondElastic(const MembraneStrain& strain) const;
  double elasticDensity(const MembraneStrain& strain) const;
  kernels::MembraneLaw law(bool viscosity) const;
  /// How many of the elements are in batches: the first ones.
  std::size_t batchedCount() const { return kernels::kBatch * batches_.size(); }

  std::vector<MembraneElement> elements_;
  kernels::BatchList<kernels::MembraneBatch> batches_;  // empty where the processor cannot use them
  Curves elastic_;
  Curves viscous_;
  bool viscosity_;
  double coupling_;  // N/m, of weft and warp
};

}  // namespace haptex::cloth
