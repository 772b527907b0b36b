// Sparse Cholesky factorisation of symmetric positive definite block matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/linear/block_matrix.h"
#include "haptex/linear/dense_kernels.h"
#include "haptex/linear/elimination.h"
#include "haptex/linear/thread_pool.h"

namespace haptex::linear {

/// Left-looking supernodal factorisation (Ng and Peyton 1993) for a fixed pattern: the symbolic
/// part and all memory belong to the constructor; factorise() and solve() allocate nothing.
///
/// In single precision the factor is that of the matrix scaled to a unit diagonal, so that it
/// neither overflows nor underflows, and a solve is a preconditioner of an iteration.
///
/// Large patterns are cut into subtrees of the elimination tree, which threads share, and a top of
/// large panels, whose rows they share. The cut is the same for any number of threads, and so is
/// every sum: the results are equal to the last bit.
template <typename T>
class BasicBlockCholesky {
 public:
  /// @param pool shares the work if it is given; has to outlive this
  explicit BasicBlockCholesky(const SymmetricBlockMatrix& pattern, ThreadPool* pool = nullptr);

  /// With the symbolic part of another factor of the same pattern, which costs most of the
  /// construction.
  /// @param memory where the factor's numbers are to lie, instead of in its own; it has to outlive
  ///   this, and whatever it had goes. For one factor after another: new memory costs page faults.
  BasicBlockCholesky(const SymmetricBlockMatrix& pattern, const Elimination& elimination,
                     ThreadPool* pool, std::vector<T>* memory = nullptr);
  BasicBlockCholesky(const BasicBlockCholesky&) = delete;
  BasicBlockCholesky& operator=(const BasicBlockCholesky&) = delete;
  BasicBlockCholesky(BasicBlockCholesky&&) = default;
  BasicBlockCholesky& operator=(BasicBlockCholesky&&) = default;

  const Elimination& elimination() const { return elimination_; }

  /// Factorises a matrix with the constructor's pattern, or the leading part of a larger one that
  /// has the constructor's pattern there. Couplings beyond the pattern are left out.
  /// @param shift added to the unit diagonal of the scaled matrix in single precision
  /// @returns false if the matrix is not positive definite to rounding or has a number that is not
  ///   finite; the factor is then unusable
  bool factorise(const SymmetricBlockMatrix& matrix, T shift = T(0));

  /// Solves A x = b with the last factor, in place. In single precision it may be called with a
  /// right-hand side of any finite size.
  void solve(BlockVector& x);

  /// Multiply-add operations of one factorisation.
  double cost() const { return cost_; }
  /// Numbers in the factor.
  double numbers() const { return static_cast<double>(numbers_); }

 private:
  static constexpr int kGroups = 8;         // of subtrees, shared by any number of threads
  static constexpr int kUpdateColumns = 8;  // block columns of an update that share a buffer

  struct Panel {
    std::size_t offset;  // of its first number in panels_
    int leading;         // numbers from one column to the next
    int first_entry;     // of those of the matrix that go here, in entries_
    int end_entry;
    int inner_rows;  // of the rows below, those in its own subtree; -1: belongs to the top
  };
  struct Entry {  // where a block of the matrix goes
    int slot;     // in lower(), or -1 - row in diagonal()
    int offset;   // in the panel
    bool transposed;
    int row, column;  // of the matrix
  };
  struct Subtree {  // supernodes [first, end)
    int first, end, group;
  };
  struct Workspace {             // of a thread
    std::vector<int> panel_row;  // by block row: its place in the current target panel
    std::vector<T> columns;      // of an update
    std::vector<RowRun> runs;    // of its rows
    std::vector<T> front;        // of the unknowns that a panel couples, in its order
    bool positive = true;
  };
  void cutTree();
  void makePanels(std::vector<T>* lent);
  void makeEntries(const SymmetricBlockMatrix& pattern);
  Entry entryOf(int row, int column, int slot) const;
  bool computeScales(const SymmetricBlockMatrix& matrix);
  void factoriseGroup(int group, const SymmetricBlockMatrix& matrix, T shift, Workspace& work);
  bool factoriseTop(int target, const SymmetricBlockMatrix& matrix, T shift);
  void collectTopDescendants();
  void load(const SymmetricBlockMatrix& matrix, int target, T shift);
  void placeRows(int target, std::vector<int>& panel_row) const;
  void applyDescendant(int descendant, int target, int first_row, int end_row,
                       const std::vector<int>& panel_row, Workspace& work);
  int findRuns(const std::vector<int>& rows, int first, int last, const std::vector<int>& panel_row,
               std::vector<RowRun>& runs) const;
  void applyDirectly(int descendant, int target, int first, int last,
                     const std::vector<int>& panel_row);
  void advance(int descendant, int target, bool into_top);
  bool factoriseNarrow(int target);
  bool factoriseWide(int target);
  template <typename Function>
  void share(int tasks, const Function& function) {
    runTasks(pool_, tasks, function);
  }
  void forward(int supernode, T* outside, std::vector<T>& front);
  void backward(int supernode, std::vector<T>& front);
  double scale(BlockVector& x);

  Elimination elimination_;
  ThreadPool* pool_;
  double cost_;
  std::vector<Panel> panel_of_;
  std::vector<T> own_memory_;  // empty if it was lent
  T* panels_ = nullptr;
  std::size_t numbers_ = 0;
  std::vector<Entry> entries_;
  std::vector<Subtree> subtrees_;
  std::vector<int> top_;        // supernodes, ascending
  std::vector<int> top_place_;  // by column, -1 where it is not in the top
  int top_columns_ = 0;
  // Lists of the factored supernodes that still update a later one, and how far each has got.
  std::vector<int> first_descendant_;
  std::vector<int> next_descendant_;
  std::vector<int> next_row_;
  std::vector<Workspace> work_;  // by thread
  std::vector<T> outside_;       // by group: what its subtrees add to the top's unknowns
  Eigen::Matrix<T, 3, -1> permuted_;
  std::vector<double> largest_;  // by part of the rows: what scale() finds
  BlockVector scales_;           // by which rows and columns are multiplied in single precision
};

using BlockCholesky = BasicBlockCholesky<double>;

extern template class BasicBlockCholesky<double>;
extern template class BasicBlockCholesky<float>;

}  // namespace haptex::linear
