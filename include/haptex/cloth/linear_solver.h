// One interface to the linear solvers, and the choice between them.
#pragma once

#include <memory>

#include "haptex/cloth/block_cholesky.h"
#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/conjugate_gradient.h"

namespace haptex::cloth {

/// How a linear system is solved.
enum class LinearSolverMethod {
  kConjugateGradient,
  kCholesky,
  kAutomatic,  ///< the cheaper one for the system at hand, see LinearSolver
};

/// Solves the systems of successive steps to a stated relative residual.
///
/// The automatic choice depends on the systems alone, not on a clock, so that a run repeats
/// exactly. Conjugate gradients get as many iterations as cost what a factorisation costs, by
/// the operation counts of both and the ratio of their speeds measured with
/// scripts/bench linear_solver. When they do not converge within them, the system is factorised,
/// and so are the next ones, at first 8 and twice as many after each further failure up to 512,
/// before conjugate gradients are tried again.
class LinearSolver {
 public:
  LinearSolver(const SymmetricBlockMatrix& pattern, LinearSolverMethod method);

  /// Solves A x = b until |b - A x| <= tolerance |b|. Allocates nothing.
  /// @param x initial guess of the conjugate gradients, overwritten by the solution
  SolveResult solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs, double tolerance,
                    BlockVector& x);

  /// What gave the last solution: kConjugateGradient or kCholesky.
  LinearSolverMethod lastMethod() const { return last_method_; }
  /// Iterations that cost as much as a factorisation; 0 without one.
  int iterationBudget() const { return iteration_budget_; }

 private:
  SolveResult solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                            double tolerance, BlockVector& x);
  SolveResult solveIteratively(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                               double tolerance, int max_iterations, BlockVector& x);

  LinearSolverMethod method_;
  LinearSolverMethod last_method_ = LinearSolverMethod::kConjugateGradient;
  ConjugateGradient conjugate_gradient_;
  std::unique_ptr<BlockCholesky> cholesky_;  // absent when only conjugate gradients are asked for
  int iteration_budget_ = 0;
  int direct_solves_left_ = 0;
  int direct_solves_next_;
  BlockVector residual_;
  BlockVector product_;
};

}  // namespace haptex::cloth
