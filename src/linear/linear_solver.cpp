#include "haptex/linear/linear_solver.h"

#include <algorithm>
#include <cmath>

namespace haptex::linear {
namespace {

// Times over that of one 3x3 block of a conjugate gradient iteration, which scripts/bench
// linear_solver prints: of one multiply-add of the factorisation in single precision, of what it
// does besides for one number of the factor (to load, to scatter, narrow panels), and of one number
// in the two triangular solves. The first two give the time of a factorisation of 2048 to 100352
// triangles within a quarter.
constexpr double kOperationOverBlock = 0.006;
constexpr double kFactorNumberOverBlock = 0.6;
constexpr double kNumberOverBlock = 0.2;
// What a factor is expected to need before one has been made.
constexpr double kExpectedSolves = 8.0;
constexpr double kExpectedIterations = 3.0;
constexpr int kMaxFreshIterations = 60;
// A coupling's block, of rank 3, and its transpose add up to 6 eigenvalues to those that conjugate
// gradients have to find.
constexpr int kMaxIterationsOfCoupling = 6;
constexpr int kFirstFreshSolves = 4;
constexpr int kMaxFreshSolves = 64;
constexpr int kFirstDirectSolves = 8;
constexpr int kMaxDirectSolves = 512;
constexpr int kMaxRefinements = 3;
constexpr int kMaxLastIterations = 100;
// Patterns of up to this many rows hold a factor in double precision from the start.
constexpr int kSmallPattern = 500;

}  // namespace

LinearSolver::LinearSolver(const SymmetricBlockMatrix& pattern, LinearSolverMethod method,
                           ThreadPool* pool)
    : method_(method),
      pool_(pool),
      conjugate_gradient_(pattern.size()),
      block_iteration_cost_(pattern.size() + 2.0 * pattern.lowerCount()),
      fresh_solves_next_(kFirstFreshSolves),
      direct_solves_next_(kFirstDirectSolves) {
  const bool small = pattern.size() <= kSmallPattern;
  if (method == LinearSolverMethod::kCholesky ||
      (method == LinearSolverMethod::kAutomatic && small)) {
    cholesky_ = std::make_unique<BlockCholesky>(pattern, pool);
    residual_.resize(3, pattern.size());
    product_.resize(3, pattern.size());
  }
  if (method != LinearSolverMethod::kAutomatic) return;
  factor_ = std::make_unique<BasicBlockCholesky<float>>(pattern, pool);
  factorisation_cost_ =
      kOperationOverBlock * factor_->cost() + kFactorNumberOverBlock * factor_->numbers();
  factor_iteration_cost_ = kNumberOverBlock * factor_->numbers() + block_iteration_cost_;
  mean_cost_ = factorisation_cost_ / kExpectedSolves + kExpectedIterations * factor_iteration_cost_;
}

int LinearSolver::iterationBudget() const {
  if (!factor_) return 0;
  return std::max(1, static_cast<int>(mean_cost_ / block_iteration_cost_));
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
  if (method_ == LinearSolverMethod::kAutomatic) {
    if (direct_solves_left_ == 0) {
      const SolveResult result = solveIteratively(matrix, rhs, tolerance, iterationBudget(), x);
      if (result.converged) {
        direct_solves_next_ = kFirstDirectSolves;
        return result;
      }
      direct_solves_left_ = direct_solves_next_;
      direct_solves_next_ = std::min(2 * direct_solves_next_, kMaxDirectSolves);
    } else {
      --direct_solves_left_;
    }
    const SolveResult result = solveByKeptFactor(matrix, rhs, tolerance, x);
    if (result.converged) return result;
    if (result.indefinite && !worth_more) return result;
    if (result.indefinite) return solveIteratively(matrix, rhs, tolerance, lastTry(), x);
  }
  const SolveResult result = solveDirectly(matrix, rhs, tolerance, x);
  if (result.converged || !worth_more) return result;
  // Not positive definite to rounding: a last try that costs a few factorisations at most.
  return solveIteratively(matrix, rhs, tolerance, lastTry(), x);
}

SolveResult LinearSolver::solveIteratively(const SymmetricBlockMatrix& matrix,
                                           const BlockVector& rhs, double tolerance,
                                           int max_iterations, BlockVector& x) {
  last_method_ = LinearSolverMethod::kConjugateGradient;
  return conjugate_gradient_.solve(matrix, rhs, tolerance, max_iterations, x);
}

bool LinearSolver::makeFactor(const SymmetricBlockMatrix& matrix) {
  ++factorisations_;
  factor_kept_ = factor_->factorise(matrix);
  solves_with_factor_ = 0;
  cost_with_factor_ = factorisation_cost_;
  return factor_kept_;
}

/// With an old factor the iterations are given up when they have cost what a new one and its
/// iterations cost, and go on with that from where they are.
SolveResult LinearSolver::solveByKeptFactor(const SymmetricBlockMatrix& matrix,
                                            const BlockVector& rhs, double tolerance,
                                            BlockVector& x) {
  last_method_ = LinearSolverMethod::kCholesky;
  SolveResult result;
  int spent = 0;
  const auto iterate = [&](int most) {
    result = conjugate_gradient_.solve(matrix, *factor_, rhs, tolerance, most, x);
    cost_with_factor_ += factor_iteration_cost_ * result.iterations;
    spent += result.iterations;
  };
  if (fresh_solves_left_ > 0) {
    --fresh_solves_left_;
  } else if (factor_kept_) {
    iterate(1 + fresh_iterations_ + static_cast<int>(factorisation_cost_ / factor_iteration_cost_));
    if (result.converged) {
      fresh_solves_next_ = kFirstFreshSolves;
    } else {
      fresh_solves_left_ = fresh_solves_next_;
      fresh_solves_next_ = std::min(2 * fresh_solves_next_, kMaxFreshSolves);
    }
  }
  if (!result.converged) {
    if (!makeFactor(matrix)) {
      result.indefinite = false;  // double precision decides
      return result;
    }
    iterate(kMaxFreshIterations + kMaxIterationsOfCoupling * matrix.couplingCount());
    fresh_iterations_ = result.iterations;
  }
  result.iterations = spent;
  ++solves_with_factor_;
  mean_cost_ = cost_with_factor_ / solves_with_factor_;
  if (factor_iteration_cost_ * spent > mean_cost_) factor_kept_ = false;
  return result;
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
