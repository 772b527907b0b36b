// Conjugate gradients with a factor that is kept over several systems.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "haptex/linear/backoff.h"
#include "haptex/linear/block_cholesky.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/linear/conjugate_gradient.h"

namespace haptex::linear {

/// A factor in single precision of one of the last systems, as preconditioner of conjugate
/// gradients. It is made anew when the last solve has cost more than the mean of all since the
/// factor was made, its making included. An old factor that has not sufficed within the cost of a
/// new one is not tried again for 4 solves, and for twice as many after each further failure up to
/// 64: in cloth that turns by degrees per step every system needs its own.
///
/// Costs are counts of operations, in those of one 3x3 block in an iteration of conjugate gradients
/// with the diagonal blocks. They leave out what couplings add to a product.
class KeptFactor {
 public:
  /// Of the fixed pattern: couplings are left out. Allocates in the constructor only.
  /// @param pool shares the work of a factor if it is given; has to outlive this
  KeptFactor(const SymmetricBlockMatrix& pattern, ThreadPool* pool);
  KeptFactor(const KeptFactor&) = delete;
  KeptFactor& operator=(const KeptFactor&) = delete;

  /// One whose factors know all couplings, for matrices of the same fixed pattern. It allocates
  /// when it makes a factor of a matrix with a coupling that the one before had no room for: an
  /// order of elimination, the structure of the factor and its memory are made anew then.
  std::unique_ptr<KeptFactor> ofWholeMatrices() const;

  /// Solves A x = b until |b - A x| <= tolerance |b|.
  /// @param most_iterations with a new factor; an old one gets as many as cost what a new one does,
  ///   as long as they are on the way to suffice (ConjugateGradient::Patience)
  /// @param x initial guess, overwritten by the solution
  /// @returns an empty result if what is factorised is not positive definite
  SolveResult solve(ConjugateGradient& conjugate_gradient, const SymmetricBlockMatrix& matrix,
                    const BlockVector& rhs, double tolerance, int most_iterations, BlockVector& x);

  /// Of a solve since the last factor was made, its making included; expected at first.
  double meanCost() const { return mean_cost_; }
  double iterationCost() const { return iteration_cost_; }
  /// To make a factor, of ofWholeMatrices() with all that is made anew; expected at first.
  double factorCost() const { return analysis_cost_ + factor_cost_; }
  long factorisations() const { return factorisations_; }
  double blockIterationCost() const { return block_iteration_cost_; }
  /// Of the fixed pattern; not there in one of ofWholeMatrices().
  const Elimination& elimination() const { return factor_->elimination(); }

 private:
  KeptFactor(ThreadPool* pool, double block_iteration_cost, double operations, double numbers);
  void setCosts(double operations, double numbers);
  bool makeFactor(const SymmetricBlockMatrix& matrix);
  void analyseWhole(const SymmetricBlockMatrix& matrix);

  ThreadPool* pool_;
  bool knows_couplings_ = false;
  std::optional<SymmetricBlockMatrix> whole_;  // the last matrix, if couplings are known
  std::vector<float> memory_;                  // of factors of whole matrices
  std::unique_ptr<BasicBlockCholesky<float>> factor_;
  bool is_kept_ = false;  // the factor, for the next solve
  double block_iteration_cost_;
  double analysis_cost_ = 0.0;
  double factor_cost_ = 0.0;
  double iteration_cost_ = 0.0;
  Backoff old_factor_{4, 64};
  int fresh_iterations_ = 0;  // of the last solve by a new factor
  int solves_ = 0;            // with the factor
  double cost_ = 0.0;         // of the factor and those
  double mean_cost_ = 0.0;
  long factorisations_ = 0;
};

}  // namespace haptex::linear
