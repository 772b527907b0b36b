// Bending of a cloth by a linear model on groups of four neighbouring particles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/membrane.h"
#include "haptex/cloth/mesh.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Four neighbouring particles, or three, one weight being zero, whose bending vector
/// sum_i weights[i] P_i is zero in every affine image of the rest shape, so in every flat state.
/// Its energy is stiffness / 2 times its square. Two kinds: the corners of two triangles that share
/// an edge, and a particle with a neighbour and those on either side of the line from that
/// neighbour through it.
struct Hinge {
  std::array<int, 4> particles;
  std::array<double, 4> weights;  ///< no unit, sum 0
  double stiffness;               ///< N/m, > 0
};

/// Linear bending forces of all hinges of a mesh (Volino and Magnenat-Thalmann 2006): the Jacobian
/// does not depend on the positions.
///
/// What a hinge resists depends on the shape of its triangles, so the stiffnesses are fitted to the
/// mesh: around every particle, for every small displacement w with constant second derivatives,
/// the energy per area is to be
///   (weft wuu^2 + warp wvv^2) / 2 + sqrt(weft warp) wuv^2,
/// a plate without transverse contraction. It is exactly that for a grid of rectangular cells
/// however they are cut, and as near as non-negative stiffnesses allow otherwise. Across a free
/// edge, where no moment can act, nothing is resisted: the half of a cell along it that no hinge
/// sees stays without curvature.
class Bending {
 public:
  /// @param mesh without defects
  /// @throws std::invalid_argument if a rigidity is not finite and >= 0
  Bending(const ClothMesh& mesh, const material::BendingRigidity& rigidity);

  const std::vector<Hinge>& hinges() const { return hinges_; }
  /// Pairs of particles, smaller index first, that the matrix of addStep() couples and that no
  /// triangle has.
  const std::vector<std::array<int, 2>>& pairs() const { return pairs_; }
  /// Looks up where the blocks of all couplings are. Before addStep().
  /// @throws std::out_of_range if the pattern lacks one
  void bind(const SymmetricBlockMatrix& matrix);

  void addForces(const Positions& positions, std::vector<Eigen::Vector3d>& forces) const;
  double energy(const Positions& positions) const;  ///< J

  /// Adds what bending contributes to a linearised stage (Stage),
  ///   matrix += -a^2 K,  rhs += a (F + ahead K v).
  void addStep(const Positions& positions, const Velocities& velocities, const StageTimes& times,
               SymmetricBlockMatrix& matrix, BlockVector& rhs) const;

  /// The sum over all hinges of stiffness weights[i] weights[j]: force on `row`
  /// stiffness (P_row - P_column), and the opposite on `column`.
  struct Coupling {
    int row;
    int column;        ///< < row
    int slot;          ///< of the block in the matrix, -1 before bind()
    double stiffness;  ///< N/m
  };
  const std::vector<Coupling>& couplings() const { return couplings_; }

 private:
  std::vector<Hinge> hinges_;
  std::vector<Coupling> couplings_;
  std::vector<double> diagonal_;  // N/m, by particle
  std::vector<std::array<int, 2>> pairs_;
};

}  // namespace haptex::cloth
