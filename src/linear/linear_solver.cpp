#include "haptex/linear/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace haptex::linear {
namespace {

constexpr int kMaxFreshIterations = 60;
// A coupling's block, of rank 3, and its transpose add up to 6 eigenvalues to those that conjugate
// gradients have to find.
constexpr int kMaxIterationsOfCoupling = 6;
constexpr int kMaxRefinements = 3;
constexpr int kMaxLastIterations = 100;
// Patterns of up to this many rows hold a factor in double precision from the start, and have none
// of whole matrices: they never allocate.
constexpr int kSmallPattern = 500;
// Of patterns beyond kMostFactoredRows: a solve by multigrid takes as long as some 15 iterations
// with the diagonal blocks at least.
constexpr int kIterationsBeforeMultigrid = 10;
constexpr int kMostCycles = 100;

}  // namespace

LinearSolver::LinearSolver(const SymmetricBlockMatrix& pattern, LinearSolverMethod method,
                           ThreadPool* pool, int most_factored_rows)
    : method_(method), pool_(pool), conjugate_gradient_(pattern.size(), pool) {
  const bool small = pattern.size() <= kSmallPattern;
  if (method == LinearSolverMethod::kCholesky ||
      (method == LinearSolverMethod::kAutomatic && small)) {
    cholesky_ = std::make_unique<BlockCholesky>(pattern, pool);
    residual_.resize(3, pattern.size());
    product_.resize(3, pattern.size());
  }
  if (method != LinearSolverMethod::kAutomatic) return;
  is_large_ = pattern.size() > most_factored_rows;
  if (is_large_) return;
  factor_ = std::make_unique<KeptFactor>(pattern, pool);
  if (!small) whole_factor_ = factor_->ofWholeMatrices();
}

long LinearSolver::factorisations() const {
  return factorisations_ + (factor_ ? factor_->factorisations() : 0) +
         (whole_factor_ ? whole_factor_->factorisations() : 0);
}

int LinearSolver::iterationBudget() const {
  if (is_large_) return kIterationsBeforeMultigrid;
  if (!factor_) return 0;
  return std::max(1, static_cast<int>(factor_->meanCost() / factor_->blockIterationCost()));
}

int LinearSolver::lastTry() const { return std::max(iterationBudget(), kMaxLastIterations); }

/// Exact conjugate gradients end after as many iterations as unknowns; rounding makes it more for
/// ill-conditioned systems.
int LinearSolver::mostIterations(const SymmetricBlockMatrix& matrix) {
  return 10 * 3 * matrix.size();
}

SolveResult LinearSolver::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                double tolerance, BlockVector& x, Definiteness definiteness) {
  const bool worth_more = definiteness == Definiteness::kPositive;
  if (method_ == LinearSolverMethod::kConjugateGradient) {
    return solveIteratively(matrix, rhs, tolerance, mostIterations(matrix), x);
  }
  if (is_large_) return solveLarge(matrix, rhs, tolerance, x, worth_more);
  if (method_ == LinearSolverMethod::kAutomatic) {
    const bool by_whole = matrix.couplingCount() > 0 && fixed_pattern_.holds();
    if (by_whole) {
      fixed_pattern_.pass();
    } else {
      const SolveResult tried = tryIterations(matrix, rhs, tolerance, x);
      if (tried.converged) return tried;
    }
    const SolveResult result = by_whole ? solveByWholeFactor(matrix, rhs, tolerance, x)
                                        : solveByKeptFactor(matrix, rhs, tolerance, x);
    if (result.converged) return result;
    if (result.indefinite && !worth_more) return result;
    if (result.indefinite) return solveIteratively(matrix, rhs, tolerance, lastTry(), x);
  }
  const SolveResult result = solveDirectly(matrix, rhs, tolerance, x);
  if (result.converged || !worth_more) return result;
  // Not positive definite to rounding: a last try that costs a few factorisations at most.
  return solveIteratively(matrix, rhs, tolerance, lastTry(), x);
}

/// With the diagonal blocks, unless they are left out for now.
SolveResult LinearSolver::tryIterations(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                        double tolerance, BlockVector& x) {
  if (iterations_.holds()) {
    iterations_.pass();
    return {};
  }
  last_method_ = LinearSolverMethod::kConjugateGradient;
  const SolveResult result = conjugate_gradient_.solve(
      matrix, rhs, tolerance, iterationBudget(), x, ConjugateGradient::Patience::kWhilePromising);
  if (result.converged) {
    iterations_.succeeded();
  } else {
    iterations_.failed();
  }
  return result;
}

SolveResult LinearSolver::solveLarge(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                     double tolerance, BlockVector& x, bool worth_more) {
  const SolveResult tried = tryIterations(matrix, rhs, tolerance, x);
  if (tried.converged) return tried;
  last_method_ = LinearSolverMethod::kConjugateGradient;
  SolveResult result;
  const auto solveByCycles = [&] {
    const int spent = result.iterations;
    result = conjugate_gradient_.solve(matrix, *multigrid_, rhs, tolerance, kMostCycles, x);
    result.iterations += spent;
  };
  if (multigrid_ && multigrid_->takeValues(matrix)) solveByCycles();
  if (result.indefinite && !worth_more) return result;
  if (!result.converged) {
    multigrid_ = std::make_unique<Multigrid>(matrix, pool_);
    if (multigrid_->takeValues(matrix)) solveByCycles();
  }
  if (result.converged) return result;
  return worth_more ? solveIteratively(matrix, rhs, tolerance, lastTry(), x) : result;
}

SolveResult LinearSolver::solveIteratively(const SymmetricBlockMatrix& matrix,
                                           const BlockVector& rhs, double tolerance,
                                           int max_iterations, BlockVector& x) {
  last_method_ = LinearSolverMethod::kConjugateGradient;
  return conjugate_gradient_.solve(matrix, rhs, tolerance, max_iterations, x);
}

SolveResult LinearSolver::solveByKeptFactor(const SymmetricBlockMatrix& matrix,
                                            const BlockVector& rhs, double tolerance,
                                            BlockVector& x) {
  last_method_ = LinearSolverMethod::kCholesky;
  const int couplings = matrix.couplingCount();
  int most = kMaxFreshIterations + kMaxIterationsOfCoupling * couplings;
  const bool whole_may_do = whole_factor_ && couplings > 0;
  if (whole_may_do) {
    const double worth = whole_factor_->factorCost() / factor_->iterationCost();
    most = std::min(most, static_cast<int>(worth) + 1);
  }
  const SolveResult result = factor_->solve(conjugate_gradient_, matrix, rhs, tolerance, most, x);
  if (!whole_may_do || result.converged || result.indefinite) {
    if (whole_may_do && result.converged) fixed_pattern_.succeeded();
    return result;
  }
  fixed_pattern_.failed();
  return solveByWholeFactor(matrix, rhs, tolerance, x);
}

SolveResult LinearSolver::solveByWholeFactor(const SymmetricBlockMatrix& matrix,
                                             const BlockVector& rhs, double tolerance,
                                             BlockVector& x) {
  last_method_ = LinearSolverMethod::kCholesky;
  return whole_factor_->solve(conjugate_gradient_, matrix, rhs, tolerance, kMaxFreshIterations, x);
}

SolveResult LinearSolver::solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                        double tolerance, BlockVector& x) {
  last_method_ = LinearSolverMethod::kCholesky;
  SolveResult result;
  const bool coupled = matrix.couplingCount() > 0;
  const double rhs_norm = rhs.norm();
  if (!coupled || rhs_norm == 0.0) x.setZero();  // else it is a guess
  if (rhs_norm == 0.0) {
    result.converged = true;
    return result;
  }
  if (!cholesky_) {
    cholesky_ = std::make_unique<BlockCholesky>(matrix, factor_->elimination(), pool_);
    residual_.resize(3, matrix.size());
    product_.resize(3, matrix.size());
  }
  ++factorisations_;
  if (!cholesky_->factorise(matrix)) return result;
  if (coupled) {
    return conjugate_gradient_.solve(matrix, *cholesky_, rhs, tolerance, mostIterations(matrix), x);
  }
  residual_ = rhs;
  for (int refinement = 0; refinement <= kMaxRefinements; ++refinement) {
    cholesky_->solve(residual_);
    x += residual_;
    matrix.multiply(x, product_);
    residual_ = rhs - product_;
    result.residual = residual_.norm() / rhs_norm;
    result.converged = result.residual <= tolerance;
    if (result.converged) break;
  }
  return result;
}

}  // namespace haptex::linear
