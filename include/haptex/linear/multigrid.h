// A multigrid cycle as preconditioner of conjugate gradients, for large sheets.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "haptex/linear/aggregation.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/linear/block_rows.h"
#include "haptex/linear/coarse_product.h"
#include "haptex/linear/thread_pool.h"

namespace haptex::linear {

/// A hierarchy of coarser matrices by smoothed aggregation (aggregation.h), the coarsest of which
/// has a factor; all in single precision. A solve is a W cycle with one step of damped Jacobi on
/// 3x3 blocks before and after what the next coarser level does: a preconditioner of an iteration,
/// as a factor in single precision is one, in time and memory that are proportional to the number
/// of rows. It is symmetric, and positive definite as long as damping times the largest eigenvalue
/// of D^-1 A is below 2: the power method estimates that eigenvalue, and nothing bounds it.
/// Conjugate gradients notice where it is not.
///
/// Groups, patterns and damping are those of the constructor's matrix. Couplings are left out: the
/// preconditioner takes them for springs that hold a particle where it is.
///
/// Sums are the same for any number of threads.
class Multigrid {
 public:
  /// @param matrix of the systems to come, or one of the same pattern that is like them
  /// @param pool   shares the work if it is given; has to outlive this
  explicit Multigrid(const SymmetricBlockMatrix& matrix, ThreadPool* pool = nullptr);

  /// Takes the values of a matrix of the constructor's pattern. Allocates nothing, as solve().
  /// @returns false if the coarsest matrix is far from positive definite or has a number that is
  ///   not finite: of no use then
  bool takeValues(const SymmetricBlockMatrix& matrix);

  /// About the solution of A x = b, in place.
  void solve(BlockVector& x);

  /// Block rows of the levels, finest first.
  std::vector<int> sizes() const;

 private:
  struct Level {
    explicit Level(BlockRows its_rows);
    BlockRows rows;
    float damping = 1.0f;  // of Jacobi's method
    PaddedVector residual, next;
    PaddedVector rhs, x, correction;  // what the next finer level, or solve(), asks for
    // To the next coarser level, if there is one.
    Interpolation interpolation;
    Interpolation restriction;
    std::unique_ptr<CoarseProduct> product;
  };

  void makeCoarser();
  void prepareCoarsest();
  void estimateDamping(Level& level);
  bool factoriseCoarsest();
  void cycle(std::size_t level, const PaddedVector& rhs, PaddedVector& x);
  void correctByCoarser(std::size_t level, PaddedVector& x);
  void smooth(Level& level, const PaddedVector& rhs, PaddedVector& x);
  void solveCoarsest(const PaddedVector& rhs, PaddedVector& x);

  ThreadPool* pool_;
  std::vector<Level> levels_;  // finest first
  std::optional<SymmetricBlockMatrix> coarsest_;
  std::vector<int> coarsest_slots_;  // of the blocks below its diagonal, by rows of the level
  std::unique_ptr<BasicBlockCholesky<float>> factor_;  // of the coarsest, unless it is large
  BlockVector coarsest_vector_;
};

}  // namespace haptex::linear
