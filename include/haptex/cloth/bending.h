// Bending of a cloth by a linear model on pairs of neighbouring triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/membrane.h"
#include "haptex/cloth/mesh.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Two triangles that share an edge. The bending vector sum_i weights[i] P_i is zero in every flat
/// state of the rest shape, affine ones included; its energy is stiffness / 2 times its square.
struct Hinge {
  std::array<int, 4> particles;   ///< both ends of the edge, then the two opposite corners
  std::array<double, 4> weights;  ///< no unit, sum 0
  double stiffness;               ///< N/m
};

/// Linear bending forces of all hinges of a mesh (Volino and Magnenat-Thalmann 2006): the Jacobian
/// does not depend on the positions.
class Bending {
 public:
  /// @param mesh without defects
  Bending(const ClothMesh& mesh, const material::BendingRigidity& rigidity);

  const std::vector<Hinge>& hinges() const { return hinges_; }
  /// Pairs of particles, smaller index first, that the matrix of addStep() couples beyond those of
  /// the triangles: the opposite corners of every hinge.
  std::vector<std::array<int, 2>> pairs() const;
  /// Looks up where the hinges' blocks are. Before addStep().
  void bind(const SymmetricBlockMatrix& matrix);

  void addForces(const Positions& positions, std::vector<Eigen::Vector3d>& forces) const;
  double energy(const Positions& positions) const;  ///< J

  /// Adds what bending contributes to the linearised backward Euler step,
  ///   matrix += -h^2 K,  rhs += h (F + h K v).
  /// @param h time step, s, finite and > 0
  void addStep(const Positions& positions, const Velocities& velocities, double h,
               SymmetricBlockMatrix& matrix, BlockVector& rhs) const;

 private:
  std::vector<Hinge> hinges_;
  std::vector<std::array<int, 6>> slots_;  // of the blocks of each pair of its particles
};

}  // namespace haptex::cloth
