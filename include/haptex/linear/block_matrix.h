// Symmetric sparse matrices of 3x3 blocks, one block row per particle: a fixed pattern, and
// couplings beyond it that come and go.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "haptex/linear/thread_pool.h"

namespace haptex::linear {

/// One 3-vector per particle: 3 x n, column i belongs to particle i.
using BlockVector = Eigen::Matrix3Xd;

/// Diagonal blocks and those below it; the blocks above are their transposes.
///
/// The pattern has a block (i, j), i > j, for every edge of the triangles and every further pair.
/// It never changes, so an element may remember the slots that it adds to.
///
/// Couplings are blocks (i, j), i != j, of any other pair, such as that of two particles of cloth
/// that touches itself: they are cleared and added anew before every solve. They are part of the
/// matrix in multiply(), eliminate(), confine() and in copies; slots and lowerCount() know the
/// fixed pattern alone. Every sum takes the fixed pattern first and then the couplings by row and
/// column, so that it does not depend on the order in which pairs were added; without couplings it
/// is what it is without this feature, to the last bit.
///
/// One outer product, scale v v^T, may be added to all of that, as the pressure in a closed volume
/// makes it: a coupling of each particle with each, at the cost of one vector.
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

  /// Adds a block, and its transpose at (column, row). What is added to one pair more than once is
  /// summed in the order of adding. A pair of the fixed pattern gets it in its slot: it is then no
  /// coupling, and clearCouplings() leaves it there.
  /// Allocates only beyond what is reserved.
  /// @throws std::out_of_range unless row and column are in [0, size) and differ
  void addCoupling(int row, int column, const Eigen::Matrix3d& block);

  /// The same, but a pair of the fixed pattern becomes a coupling, too, which factors do not know:
  /// so a sum of terms keeps the fixed part positive semidefinite that has others beyond it.
  void addBeyondPattern(int row, int column, const Eigen::Matrix3d& block);

  /// In the place of the one before. clearCouplings() takes it out. Allocates the first time.
  /// @param scale >= 0 @param vector 3 x size
  void setOuterProduct(double scale, const BlockVector& vector);

  /// Whether the block of two particles belongs to the fixed pattern.
  bool hasInPattern(int row, int column) const;

  /// The fixed pattern keeps its values.
  void clearCouplings();

  /// Pairs beyond the fixed pattern, those of addBeyondPattern() among them; an outer product
  /// counts as one.
  int couplingCount() const {
    return static_cast<int>(couplings_.size()) + (outer_scale_ > 0.0 ? 1 : 0);
  }

  /// Makes room for that many pairs beyond the fixed pattern. A copy holds the couplings without
  /// the room; assigning leaves the room of what is assigned to, and allocates only if it is too
  /// small.
  void reserveCouplings(std::size_t count);

  /// The fixed pattern and the couplings of this matrix as one fixed pattern, all blocks zero.
  SymmetricBlockMatrix wholePattern() const;

  /// Takes the values of another matrix, couplings included, into the fixed pattern. Blocks that
  /// the other has not become zero; an outer product is left out.
  /// @returns false, with values of no use, if the other has a block that the pattern has not
  bool takeValues(const SymmetricBlockMatrix& other);

  /// Clears the couplings, too. @param pool as of multiply()
  void setZero(ThreadPool* pool = nullptr);

  /// y = A x. @param pool shares the work of more than kSharedRows rows (shared_rows.h), to the
  ///   same result; may be null
  void multiply(const BlockVector& x, BlockVector& y, ThreadPool* pool = nullptr) const;

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
  struct Coupling {
    int row, column;  // row > column
    int next;         // in couplings_: that of the row's next column; -1: none
    Eigen::Matrix3d block;
  };
  /// Of a block above the diagonal, which is the transpose of one below.
  struct Upper {
    int slot, column;
  };
  void listUpper();
  void multiplyInOrder(const BlockVector& x, BlockVector& y) const;
  void multiplyRows(int begin, int end, const BlockVector& x, BlockVector& y) const;
  int find(int row, int column) const;
  void requirePair(int row, int column) const;
  template <typename Function>
  void forEachCoupling(const Function& function) const;

  std::vector<Eigen::Matrix3d> diagonal_;
  std::vector<Eigen::Matrix3d> lower_;
  std::vector<int> row_begin_;
  std::vector<int> columns_;
  // By row, columns ascending, if there are more than kSharedRows of them.
  std::vector<int> upper_begin_;
  std::vector<Upper> upper_;
  std::vector<Coupling> couplings_;  // in the order of adding
  // By row: in couplings_, the one of the lowest column; -1: none. Empty without couplings.
  std::vector<int> first_coupling_;
  double outer_scale_ = 0.0;  // 0: no outer product
  BlockVector outer_;         // if there is one
};

}  // namespace haptex::linear
