// Membrane forces of quadrilateral cells that have one strain each: two triangles that do not lock
// each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/cells/triangle_pairs.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Strains of a cell. The first three, weft, warp and shear, are the means of the Green-Lagrange
/// strains of the bilinear cell; the last three are those of its first triangle less those of its
/// second.
using CellStrain = Eigen::Matrix<double, 6, 1>;

/// A cell at rest. As Green-Lagrange strains are linear in the squares of distances, and those of a
/// cell are sums of such strains,
///   strain = by_squares (squares of the six distances of its particles - those at rest).
struct BilinearCell {
  std::array<int, 4> particles;  ///< ascending
  std::array<int, 6> slots;      ///< of the matrix blocks (1,0), (2,0), (2,1), (3,0), (3,1), (3,2)
                                 ///< of the particles; -1 before bind()
  Eigen::Matrix<double, 6, 6> by_squares;  ///< 1/m^2, columns in the order of the slots
  CellStrain rest_squares;                 ///< m^2, in the same order
  double area;                             ///< m^2
  double first_share;                      ///< of the area: the first triangle's
};

/// With G the mean gradient of the weights over a cell of the area A, which is alike for either
/// diagonal, and r_t, A_t of the four triangles that both diagonals make, the mean strain is that
/// of the quadratic form
///   2/3 G G^T + 1/6 sum_t A_t / A r_t r_t^T,
/// which in a parallelogram is the exact mean over the bilinear map.
BilinearCell restCell(const TrianglePair& pair);

/// Elastic and, if asked for, viscous forces of cells: per cell the energy
///   A W(e) + A1 A2 / A k |d|^2 / 2
/// of the mean strain e and the difference d of both triangles' strains. The second, soft part
/// resists what e does not see, and k is a tenth of the smallest of the fabric's slopes at rest. A
/// sheet has half as many strains e as it would have with triangles, so that threads that do not
/// stretch leave it free to bend in all directions (docs/mechanics.md, Locking).
///
/// Newton iterations hold the mean strains at the beginning of a stage, as Membrane does.
class BilinearCells final : public Force {
 public:
  /// @param pairs     of pairTriangles()
  /// @param viscosity whether the viscous curves act, on the mean strains
  BilinearCells(const std::vector<TrianglePair>& pairs, const material::Fabric& fabric,
                bool viscosity);

  const std::vector<BilinearCell>& cells() const { return cells_; }

  /// Both diagonals of every cell.
  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// Slopes are clamped to >= 0. The geometric part is exact where it is a sum of those of
  /// triangles in tension; elsewhere the mean stresses are projected by projectStress(), and those
  /// of the soft part left out.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  std::size_t heldSize() const override { return cells_.size(); }
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

 private:
  using Curves = std::array<material::StrainStressCurve, 3>;  // weft, warp, shear
  struct Response;
  Response respond(const BilinearCell& cell, const CellStrain& strain) const;
  void addViscous(const BilinearCell& cell, const Eigen::Vector3d& rate, double a,
                  Response& response) const;
  double elasticEnergy(const BilinearCell& cell, const CellStrain& strain) const;

  std::vector<BilinearCell> cells_;
  Curves elastic_;
  Curves viscous_;
  bool viscosity_;
  double soft_modulus_;  // N/m
};

}  // namespace haptex::cloth
