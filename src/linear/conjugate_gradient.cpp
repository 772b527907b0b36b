#include "haptex/linear/conjugate_gradient.h"

#include <Eigen/LU>

#include "haptex/linear/multigrid.h"

namespace haptex::linear {

namespace {

double dot(const BlockVector& a, const BlockVector& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

ConjugateGradient::ConjugateGradient(int size)
    : inverse_diagonal_(size),
      residual_(3, size),
      preconditioned_(3, size),
      direction_(3, size),
      product_(3, size) {}

SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                     double tolerance, int max_iterations, BlockVector& x) {
  for (int i = 0; i < matrix.size(); ++i) inverse_diagonal_[i] = matrix.diagonal(i).inverse();
  const auto precondition = [&] {
    for (int i = 0; i < matrix.size(); ++i) {
      preconditioned_.col(i).noalias() = inverse_diagonal_[i] * residual_.col(i);
    }
  };
  return iterate(matrix, precondition, rhs, tolerance, max_iterations, x);
}

template <typename Factor>
SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix& matrix, Factor& factor,
                                     const BlockVector& rhs, double tolerance, int max_iterations,
                                     BlockVector& x) {
  const auto precondition = [&] {
    preconditioned_ = residual_;
    factor.solve(preconditioned_);
  };
  return iterate(matrix, precondition, rhs, tolerance, max_iterations, x);
}

template <typename Precondition>
SolveResult ConjugateGradient::iterate(const SymmetricBlockMatrix& matrix,
                                       const Precondition& precondition, const BlockVector& rhs,
                                       double tolerance, int max_iterations, BlockVector& x) {
  SolveResult result;
  const double rhs_norm = rhs.norm();
  if (rhs_norm == 0.0) {
    x.setZero();
    result.converged = true;
    return result;
  }
  const auto restart = [&] {
    matrix.multiply(x, product_);
    residual_ = rhs - product_;
    result.residual = residual_.norm() / rhs_norm;
    result.converged = result.residual <= tolerance;
  };

  const auto start_from_zero = [&] {
    x.setZero();
    residual_ = rhs;
    result.residual = 1.0;
    result.converged = result.residual <= tolerance;
  };

  if (x.isZero(0.0)) {
    start_from_zero();
  } else {
    restart();
    if (!(result.residual <= 1.0)) start_from_zero();  // worse than none, or not a number
  }
  while (!result.converged && result.iterations < max_iterations) {
    const double before = result.residual;
    precondition();
    direction_ = preconditioned_;
    double slope = dot(residual_, preconditioned_);
    double recurrence = result.residual;
    while (result.iterations < max_iterations) {
      matrix.multiply(direction_, product_);
      const double curvature = dot(direction_, product_);
      result.indefinite = !(curvature > 0.0);  // to rounding, or not a number
      if (result.indefinite) break;
      const double step = slope / curvature;
      x += step * direction_;
      residual_ -= step * product_;
      ++result.iterations;
      recurrence = residual_.norm() / rhs_norm;
      if (recurrence <= tolerance) break;
      precondition();
      const double next_slope = dot(residual_, preconditioned_);
      direction_ = preconditioned_ + (next_slope / slope) * direction_;
      slope = next_slope;
    }
    restart();
    // Below the rounding of the matrix-vector product another round cannot help.
    if (!(result.residual < 0.5 * before)) break;
  }
  if (!(result.residual <= 1.0)) {  // diverged: no change at all is nearer to the solution
    x.setZero();
    restart();
  }
  return result;
}

template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&,
                                              BasicBlockCholesky<float>&, const BlockVector&,
                                              double, int, BlockVector&);
template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&,
                                              BasicBlockCholesky<double>&, const BlockVector&,
                                              double, int, BlockVector&);
template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&, Multigrid&,
                                              const BlockVector&, double, int, BlockVector&);

}  // namespace haptex::linear
