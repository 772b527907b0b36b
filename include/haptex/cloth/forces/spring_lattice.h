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
/// The functions are those of Membrane; the strains of springs 3 t, 3 t + 1 and 3 t + 2 share the
/// entry t of a vector of strains.
class SpringLattice {
 public:
  /// @param viscosity whether the viscous curves of the fabric act, combined as the elastic ones
  /// @param bend      whether there are bend springs; every fabric must then have a rigidity
  /// @throws std::invalid_argument as findLatticeSprings()
  SpringLattice(const mesh::ClothMesh& mesh, const material::Fabric& fabric, bool viscosity,
                bool bend);

  void setFabric(const material::Fabric& fabric);

  const std::vector<LatticeSpring>& springs() const { return springs_; }
  /// Pairs of particles with a spring, smaller index first.
  std::vector<std::array<int, 2>> pairs() const;
  /// @throws std::out_of_range if the pattern lacks a pair
  void bind(const linear::SymmetricBlockMatrix& matrix);

  void addForces(const Positions& positions, const Velocities& velocities,
                 std::vector<Eigen::Vector3d>& forces) const;
  double elasticEnergy(const Positions& positions) const;  ///< J

  /// As Membrane::addStep(). The block of each spring is projected exactly: across a compressed
  /// spring its stiffness is 0, along it at least 0.
  void addStep(const Positions& positions, const Velocities& velocities, const StageTimes& times,
               linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  /// As Membrane::addNewton().
  void addNewton(const Positions& positions, const std::vector<MembraneStrain>& begin_strains,
                 double h, Membrane::Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                 linear::BlockVector& rhs) const;
  double incrementalPotential(const Positions& positions,
                              const std::vector<MembraneStrain>& begin_strains, double h) const;

  std::size_t strainCount() const { return (springs_.size() + 2) / 3; }
  void computeStrains(const Positions& positions, std::vector<MembraneStrain>& strains) const;
  void computeStrainsBefore(const Positions& positions, const Velocities& velocities,
                            double interval, std::vector<MembraneStrain>& strains) const;

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
  bool bend_;
};

}  // namespace haptex::cloth
