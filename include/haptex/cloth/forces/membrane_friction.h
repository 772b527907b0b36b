// Friction in a fabric that is stretched and sheared: the hysteresis of its membrane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/cloth/forces/friction_laws.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// The fabric of the Membrane beside MembraneFriction: the curves of weft and warp are less by
/// what friction adds to them when the fabric is stretched for the first time; that of shear, the
/// middle of its loop, stays.
/// @param fabric with a resilience
material::Fabric elasticShare(material::Fabric fabric);

/// Friction stresses (friction_laws.h) in every element of a mesh, beside those of the membrane.
/// What they remember, three numbers per element, stays until a step is accepted.
class MembraneFriction final : public Force {
 public:
  /// @param elements of restElements() @param fabric with a resilience and a hysteresis of shear
  /// @throws std::invalid_argument if a resilience is not from TensileResilience::kLeast to 1, or a
  ///   hysteresis not finite and >= 0
  MembraneFriction(std::vector<MembraneElement> elements, const material::Fabric& fabric);

  /// Whether the fabric returns all work.
  static bool isZero(const material::Fabric& fabric);

  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  /// Per element the works of weft and warp, J/m^2, and the plastic shear.
  std::size_t memorySize() const override { return 3 * elements_.size(); }
  std::vector<std::vector<int>> memoryOwners() const override;
  /// To those with which weft and warp are on their curves, as if they had been stretched to here
  /// from rest, and shear meets no friction.
  void forget(const Positions& positions, double* memory) const override;
  void remember(const Positions& positions, double* memory) const override;

  double energy(const ForceState& state) const override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// The stresses are those of the strains to which the rates lead in the time ahead, with the
  /// secant as their slope, so that the solve does not overshoot where friction changes sign; their
  /// part of the geometric stiffness is projected.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  /// The same at the positions; the exact Hessian has the tangent, and is not projected.
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;

 private:
  struct Response {
    Eigen::Vector3d stress, tangent, secant;  // N/m, weft, warp, shear
    double energy;                            // J/m^2
  };
  Response respond(const MembraneStrain& strain, const double* memory) const;
  void addTractions(const MembraneElement& element, const ElementFrame& frame,
                    const Eigen::Vector3d& stress, double factor, linear::BlockVector& rhs) const;

  std::vector<MembraneElement> elements_;
  std::array<ThreadFriction, 2> threads_;  // weft, warp
  ShearFriction shear_;
};

}  // namespace haptex::cloth
