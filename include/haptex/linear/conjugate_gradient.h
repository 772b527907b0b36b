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
/// solve() allocates nothing. Sums over more than kSharedRows rows (shared_rows.h) are those of its
/// parts, so that threads change no result.
class ConjugateGradient {
 public:
  /// When a solve ends that has neither converged nor spent its iterations.
  enum class Patience {
    kToTheEnd,  ///< when its matrix shows to be indefinite
    /// also from a quarter of its iterations on, when it is slower than would be 0.7 of an even
    /// pace to its tolerance (on the logarithm of the residual)
    kWhilePromising,
  };

  /// @param size number of block rows of the matrices to come
  /// @param pool shares the work if it is given; has to outlive this
  explicit ConjugateGradient(int size, ThreadPool* pool = nullptr);

  /// Solves A x = b until |b - A x| <= tolerance |b| or max_iterations are spent.
  /// The recurrence's residual is replaced by the true one before convergence is declared, so that
  /// the reported one is never just believed.
  /// @param x the initial guess, dropped if zero is a better one; overwritten by the solution
  SolveResult solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs, double tolerance,
                    int max_iterations, BlockVector& x, Patience patience = Patience::kToTheEnd);
  /// The same with another preconditioner, in double precision but for that.
  /// @tparam Factor BasicBlockCholesky of float or double, or Multigrid
  template <typename Factor>
  SolveResult solve(const SymmetricBlockMatrix& matrix, Factor& factor, const BlockVector& rhs,
                    double tolerance, int max_iterations, BlockVector& x,
                    Patience patience = Patience::kToTheEnd);

 private:
  template <typename Precondition>
  SolveResult iterate(const SymmetricBlockMatrix& matrix, const Precondition& precondition,
                      const BlockVector& rhs, double tolerance, int max_iterations, BlockVector& x,
                      Patience patience);

  template <typename Function>
  void share(const Function& function);
  template <typename Function>
  double sum(const Function& function);
  double dot(const BlockVector& a, const BlockVector& b);
  double norm(const BlockVector& a);

  ThreadPool* pool_;
  std::vector<double> partial_sums_;
  std::vector<Eigen::Matrix3d> inverse_diagonal_;
  BlockVector residual_;
  BlockVector preconditioned_;
  BlockVector direction_;
  BlockVector product_;
};

}  // namespace haptex::linear
