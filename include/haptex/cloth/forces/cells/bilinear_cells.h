// Membrane forces of quadrilateral cells that have two strains each: two triangles that do not lock
// each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/cells/bilinear_cell.h"
#include "haptex/cloth/forces/cells/bilinear_kernel.h"
#include "haptex/cloth/forces/cells/triangle_pairs.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// Elastic and, if asked for, viscous forces of cells, which have the energy A/2 (W(e) + W(f)) of
/// their two strains e and f (restCell()). Threads that do not stretch leave a sheet of them freer
/// to bend than one of triangles does (docs/mechanics.md, Locking).
///
/// Newton iterations hold the strains at the beginning of a stage, as Membrane does.
class BilinearCells final : public Force {
 public:
  /// @param pairs     of pairTriangles()
  /// @param viscosity whether the viscous curves act
  BilinearCells(const std::vector<TrianglePair>& pairs, const material::Fabric& fabric,
                bool viscosity);

  const std::vector<BilinearCell>& cells() const { return cells_; }

  /// Both diagonals of every cell.
  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;

  /// Slopes are clamped to >= 0, and the geometric part of each cell is projected: projectPulls().
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

  std::size_t heldSize() const override { return 2 * cells_.size(); }
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
  void addViscous(const BilinearCell& cell, const CellStrain& rate, double a,
                  Response& response) const;
  double elasticEnergy(const BilinearCell& cell, const CellStrain& strain) const;
  kernels::MembraneLaw law(bool viscosity) const;
  /// How many of the cells are in batches: the first ones.
  std::size_t batchedCount() const { return kernels::kBatch * batches_.size(); }

  std::vector<BilinearCell> cells_;
  kernels::BatchList<kernels::BilinearBatch> batches_;  // empty where the processor cannot use them
  Curves elastic_;
  Curves viscous_;
  bool viscosity_;
};

}  // namespace haptex::cloth
