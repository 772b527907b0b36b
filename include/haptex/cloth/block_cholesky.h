// Sparse Cholesky factorisation of symmetric positive definite block matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/elimination.h"

namespace haptex::cloth {

/// Left-looking supernodal factorisation (Ng and Peyton 1993) for a fixed pattern: the symbolic
/// part and all memory belong to the constructor; factorise() and solve() allocate nothing.
class BlockCholesky {
 public:
  explicit BlockCholesky(const SymmetricBlockMatrix& pattern);

  /// Factorises a matrix with the constructor's pattern, or the leading part of a larger one that
  /// has the constructor's pattern there.
  /// @returns false if the matrix is not positive definite to rounding or has a number that is not
  ///   finite; the factor is then unusable
  bool factorise(const SymmetricBlockMatrix& matrix);

  /// Solves A x = b with the last factor, in place.
  void solve(BlockVector& x);

  /// Multiply-add operations of one factorisation.
  double cost() const { return cost_; }

 private:
  struct Panel {
    std::size_t offset;  // of its first double in panels_
    int leading;         // doubles from one column to the next
    int first_entry;     // of those of the matrix that go here, in entries_
    int end_entry;
  };
  struct Entry {  // where a block of the matrix goes
    int slot;     // in lower(), or -1 - row in diagonal()
    int offset;   // in the panel
    bool transposed;
  };
  void load(const SymmetricBlockMatrix& matrix, int target);
  void applyDescendant(int descendant, int target);
  bool factorisePanel(int target);
  Entry entryOf(int row, int column, int slot, bool transposed) const;

  Elimination elimination_;
  double cost_;
  std::vector<Panel> panel_of_;
  std::vector<double> panels_;
  std::vector<Entry> entries_;
  // Lists of the factored supernodes that still update a later one, and how far each has got.
  std::vector<int> first_descendant_;
  std::vector<int> next_descendant_;
  std::vector<int> next_row_;
  std::vector<int> panel_row_;  // by block row: its place in the current target panel
  std::vector<double> update_;
  std::vector<double> front_;  // of the unknowns that a panel couples, in its order
  BlockVector permuted_;
};

}  // namespace haptex::cloth
