// Preconditioned conjugate gradients on symmetric positive definite block matrices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::linear {

/// Outcome of a linear solve.
struct SolveResult {
  bool converged = false;
  int iterations = 0;
  double residual = 0.0;    ///< |b - A x| / |b|
  bool indefinite = false;  ///< a direction d with d . A d <= 0 was met, or not a number
};

/// Conjugate gradients (Hestenes and Stiefel 1952), preconditioned by the inverse diagonal blocks,
/// by the factor of a matrix that is near or by multigrid. All buffers are made by the constructor;
/// solve() allocates nothing.
class ConjugateGradient {
 public:
  /// @param size number of block rows of the matrices to come
  explicit ConjugateGradient(int size);

  /// Solves A x = b until |b - A x| <= tolerance |b| or max_iterations are spent.
  /// The recurrence's residual is replaced by the true one before convergence is declared, so that
  /// the reported one is never just believed.
  /// @param x the initial guess, dropped if zero is a better one; overwritten by the solution
  SolveResult solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs, double tolerance,
                    int max_iterations, BlockVector& x);
  /// The same with another preconditioner, in double precision but for that.
  /// @tparam Factor BasicBlockCholesky of float or double, or Multigrid
  template <typename Factor>
  SolveResult solve(const SymmetricBlockMatrix& matrix, Factor& factor, const BlockVector& rhs,
                    double tolerance, int max_iterations, BlockVector& x);

 private:
  template <typename Precondition>
  SolveResult iterate(const SymmetricBlockMatrix& matrix, const Precondition& precondition,
                      const BlockVector& rhs, double tolerance, int max_iterations, BlockVector& x);

  std::vector<Eigen::Matrix3d> inverse_diagonal_;
  BlockVector residual_;
  BlockVector preconditioned_;
  BlockVector direction_;
  BlockVector product_;
};

}  // namespace haptex::linear
