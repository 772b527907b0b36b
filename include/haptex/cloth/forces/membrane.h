// The Green-Lagrange membrane element of Volino and Magnenat-Thalmann 2005 on every triangle of a
// cloth; the equations stand in docs/mechanics.md.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/element_assembly.h"
#include "haptex/cloth/forces/membrane_kernel.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

using Positions = std::vector<Eigen::Vector3d>;   ///< m, one per particle
using Velocities = std::vector<Eigen::Vector3d>;  ///< m/s, one per particle

/// Times (s) of an implicit stage, x = x* + a v, that is linearised about a state (Stage).
struct StageTimes {
  double a;           ///< > 0; the time step in backward Euler
  double ahead;       ///< in which the state's velocities bring it to the stage: a in backward
                      ///< Euler, 0 if it is there already
  double time = 0.0;  ///< simulated, of the stage: when forces act that depend on time
};

/// Green-Lagrange strains or their rates (1/s) in the order weft (U.U-1)/2, warp (V.V-1)/2,
/// shear U.V.
using MembraneStrain = Eigen::Vector3d;

/// Projects the symmetric tensor [[s0, s2], [s2, s1]] to its nearest positive semidefinite one
/// (Frobenius norm) by clamping its two eigenvalues in closed form.
Eigen::Vector3d projectStress(const Eigen::Vector3d& stress);

/// Elastic and, if asked for, viscous membrane forces of all elements of a mesh. Positions and
/// velocities have one entry per particle; their numbers are not checked here (Cloth does).
class Membrane {
 public:
  /// @param mesh without defects (findDefects())
  /// @param viscosity   whether the viscous curves of the fabric act
  /// @param contraction whether its transverse contraction does: suu += c evv, svv += c euu with
  ///   c of material::contractionModulus()
  Membrane(const mesh::ClothMesh& mesh, const material::Fabric& fabric, bool viscosity,
           bool contraction = false);

  /// Takes the curves and the contraction of another fabric.
  void setFabric(const material::Fabric& fabric);

  /// Looks up the elements' slots in a matrix whose pattern has more than the mesh's edges.
  /// @throws std::out_of_range if the pattern lacks one of them
  void bind(const linear::SymmetricBlockMatrix& matrix);

  const std::vector<MembraneElement>& elements() const { return elements_; }

  /// Strain of one element.
  MembraneStrain strain(const MembraneElement& element, const Positions& positions) const;

  /// Adds the membrane forces (N): F_i = -A [suu ru_i U + svv rv_i V + suv (ru_i V + rv_i U)].
  void addForces(const Positions& positions, const Velocities& velocities,
                 std::vector<Eigen::Vector3d>& forces) const;

  /// Elastic energy (J).
  double elasticEnergy(const Positions& positions) const;

  /// Adds what the membrane contributes to a linearised stage (Stage),
  ///   matrix += -a D - a^2 K,  rhs += a (F + ahead K v),
  /// with the exact projection: slopes of the curves clamped to >= 0, those of weft and warp
  /// together with the contraction by projectStress(), as the stress of the geometric part is; the
  /// same K on both sides.
  void addStep(const Positions& positions, const Velocities& velocities, const StageTimes& times,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  /// The Hessian of a Newton iteration: exact, for fast convergence near a minimum, or projected as
  /// in addStep(), for a descent from everywhere.
  enum class Hessian { kExact, kProjected };

  /// Adds what the membrane contributes to a Newton iteration on the incremental potential
  ///   sum_elements A [W(e) + h G((e - e0)/h)],  G the integral of the viscous curves,
  /// whose discrete strain rate is exactly zero under rigid motion:
  ///   matrix += h^2 times its Hessian, rhs -= h times its gradient.
  /// @param positions     at the end of the step
  /// @param begin_strains e0 of every element, strains at the beginning of the step
  /// @param h             a of the stage (StageTimes), s, finite and > 0
  void addNewton(const Positions& positions, const std::vector<MembraneStrain>& begin_strains,
                 double h, Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                 linear::BlockVector& rhs) const;

  /// The incremental potential of addNewton() (J).
  double incrementalPotential(const Positions& positions,
                              const std::vector<MembraneStrain>& begin_strains, double h) const;

  /// How many strains the functions below make.
  std::size_t strainCount() const { return elements_.size(); }
  /// Strains of all elements. @param strains resized to the number of elements
  void computeStrains(const Positions& positions, std::vector<MembraneStrain>& strains) const;
  /// What the strains would have been at their present rates `interval` seconds before.
  /// @param strains resized to the number of elements
  void computeStrainsBefore(const Positions& positions, const Velocities& velocities,
                            double interval, std::vector<MembraneStrain>& strains) const;

  /// The exact Jacobians of the forces of one element: blocks [i][j] are dF_i/dP_j (N/m) and
  /// dF_i/dv_j (N.s/m) of its particles in the order of `particles`. With viscosity dF/dP is not
  /// symmetric, because the strain rate depends on the position.
  struct Jacobian {
    std::array<std::array<Eigen::Matrix3d, 3>, 3> by_position;
    std::array<std::array<Eigen::Matrix3d, 3>, 3> by_velocity;
  };
  Jacobian exactJacobian(const MembraneElement& element, const Positions& positions,
                         const Velocities& velocities) const;

 private:
  using Curves = std::array<material::StrainStressCurve, 3>;  // weft, warp, shear
  struct Frame;                                               // U, V of an element, or their rates
  struct Response;                                            // stress and slopes
  static Frame frame(const MembraneElement& element, const std::vector<Eigen::Vector3d>& points);
  template <bool kViscous>
  void addStepOf(const MembraneElement& element, const Positions& positions,
                 const Velocities& velocities, const StageTimes& times,
                 linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  static Response respond(const Curves& curves, const MembraneStrain& strain);
  Response respondElastic(const MembraneStrain& strain) const;
  double elasticDensity(const MembraneStrain& strain) const;
  kernels::MembraneLaw law(bool viscosity) const;

  std::vector<MembraneElement> elements_;
  std::vector<kernels::MembraneBatch> batches_;  // empty where the processor cannot use them
  Curves elastic_;
  Curves viscous_;
  bool viscosity_;
  bool contraction_;
  double coupling_ = 0.0;  // N/m, of weft and warp
};

}  // namespace haptex::cloth
