#include "haptex/cloth/linear_solver.h"

#include <algorithm>

namespace haptex::cloth {
namespace {

// Time of one multiply-add of the factorisation (with its share of the two triangular solves) over
// that of one 3x3 block of a conjugate gradient iteration; scripts/bench linear_solver prints it.
constexpr double kFactorisationOverBlock = 0.04;
constexpr int kFirstDirectSolves = 8;
constexpr int kMostDirectSolves = 512;
constexpr int kMostRefinements = 3;

int iterationBudget(const SymmetricBlockMatrix& pattern, const BlockCholesky& cholesky) {
  const double blocks = pattern.size() + 2.0 * pattern.lowerCount();
  return std::max(1, static_cast<int>(kFactorisationOverBlock * cholesky.cost() / blocks));
}

}  // namespace

LinearSolver::LinearSolver(const SymmetricBlockMatrix& pattern, LinearSolverMethod method)
    : method_(method),
      conjugate_gradient_(pattern.size()),
      direct_solves_next_(kFirstDirectSolves),
      residual_(3, pattern.size()),
      product_(3, pattern.size()) {
  if (method == LinearSolverMethod::kConjugateGradient) return;
  cholesky_ = std::make_unique<BlockCholesky>(pattern);
  iteration_budget_ = haptex::cloth::iterationBudget(pattern, *cholesky_);
}

SolveResult LinearSolver::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                double tolerance, BlockVector& x) {
  if (method_ == LinearSolverMethod::kConjugateGradient) {
    // Exact conjugate gradients end after as many iterations as unknowns; rounding makes it more
    // for ill-conditioned systems.
    return solveIteratively(matrix, rhs, tolerance, 10 * 3 * matrix.size(), x);
  }
  if (method_ == LinearSolverMethod::kAutomatic) {
    if (direct_solves_left_ == 0) {
      const SolveResult result = solveIteratively(matrix, rhs, tolerance, iteration_budget_, x);
      if (result.converged) {
        direct_solves_next_ = kFirstDirectSolves;
        return result;
      }
      direct_solves_left_ = direct_solves_next_;
      direct_solves_next_ = std::min(2 * direct_solves_next_, kMostDirectSolves);
    } else {
      --direct_solves_left_;
    }
  }
  const SolveResult result = solveDirectly(matrix, rhs, tolerance, x);
  if (result.converged) return result;
  // Not positive definite to rounding: a last try that costs a few factorisations at most.
  return solveIteratively(matrix, rhs, tolerance, std::max(iteration_budget_, 100), x);
}

SolveResult LinearSolver::solveIteratively(const SymmetricBlockMatrix& matrix,
                                           const BlockVector& rhs, double tolerance,
                                           int max_iterations, BlockVector& x) {
  last_method_ = LinearSolverMethod::kConjugateGradient;
  return conjugate_gradient_.solve(matrix, rhs, tolerance, max_iterations, x);
}

SolveResult LinearSolver::solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                        double tolerance, BlockVector& x) {
  last_method_ = LinearSolverMethod::kCholesky;
  SolveResult result;
  const double rhs_norm = rhs.norm();
  x.setZero();
  if (rhs_norm == 0.0) {
    result.converged = true;
    return result;
  }
  if (!cholesky_->factorise(matrix)) return result;
  residual_ = rhs;
  for (int refinement = 0; refinement <= kMostRefinements; ++refinement) {
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

}  // namespace haptex::cloth
