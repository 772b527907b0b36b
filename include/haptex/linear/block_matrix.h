// Symmetric sparse matrices of 3x3 blocks with a fixed pattern: one block row per particle.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace haptex::linear {

/// One 3-vector per particle: 3 x n, column i belongs to particle i.
using BlockVector = Eigen::Matrix3Xd;

/// Diagonal blocks and those below it; the blocks above are their transposes.
///
/// The pattern has a block (i, j), i > j, for every edge of the triangles and every further pair.
/// It never changes, so an element may remember the slots that it adds to.
class SymmetricBlockMatrix {
 public:
  /// @param size      number of block rows
  /// @param triangles particle indices in [0, size)
  /// @param pairs     likewise, in any order; may repeat each other and the triangles' edges
  SymmetricBlockMatrix(int size, const std::vector<std::array<int, 3>>& triangles,
                       const std::vector<std::array<int, 2>>& pairs = {});

  int size() const { return static_cast<int>(diagonal_.size()); }
  int lowerCount() const { return static_cast<int>(lower_.size()); }

  /// Slot of the block (row, column), row > column, in lower().
  /// @throws std::out_of_range if the pattern has no such block
  int slot(int row, int column) const;

  Eigen::Matrix3d& diagonal(int row) { return diagonal_[row]; }
  const Eigen::Matrix3d& diagonal(int row) const { return diagonal_[row]; }
  Eigen::Matrix3d& lower(int slot) { return lower_[slot]; }
  const Eigen::Matrix3d& lower(int slot) const { return lower_[slot]; }

  /// Slots of block row i: [rowBegin(i), rowBegin(i + 1)), columns ascending.
  int rowBegin(int row) const { return row_begin_[row]; }
  int column(int slot) const { return columns_[slot]; }

  void setZero();

  /// y = A x.
  void multiply(const BlockVector& x, BlockVector& y) const;

  /// Fixes the unknowns of some particles: moves their columns to the right-hand side and leaves
  /// an identity block with a zero right-hand side, so that their unknown in the solution is zero
  /// and has to be set to its value afterwards.
  /// @param fixed  per particle, nonzero where the unknown is given
  /// @param values the given unknowns; other columns are not read
  void eliminate(const std::vector<char>& fixed, const BlockVector& values, BlockVector& rhs);

  /// Fixes the component along one direction of the unknowns of some particles, likewise: in the
  /// solution it is zero and has to be set to its value afterwards.
  /// @param confined per particle, nonzero where there is a direction
  /// @param normals  the directions, of unit length; other columns are not read
  /// @param values   the given components, times their direction; other columns are not read
  void confine(const std::vector<char>& confined, const BlockVector& normals,
               const BlockVector& values, BlockVector& rhs);

 private:
  std::vector<Eigen::Matrix3d> diagonal_;
  std::vector<Eigen::Matrix3d> lower_;
  std::vector<int> row_begin_;
  std::vector<int> columns_;
};

}  // namespace haptex::linear
