#include "haptex/contact/patch_solver.h"

#include <algorithm>
#include <cmath>

namespace haptex::contact {
namespace {

using cloth::BlockVector;
using cloth::SymmetricBlockMatrix;

constexpr int kFew = 2;         // iterations of a step: the factor is good enough as it is
constexpr int kMost = 10;       // after which a new factor is worth its time
constexpr double kShare = 0.2;  // of the factor that is renewed in a step
constexpr int kMostAgain = 4;   // iterations of solveAgain()

/// y = A x for the leading part.
void multiplyLeading(const SymmetricBlockMatrix& matrix, const BlockVector& x, BlockVector& y) {
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const int row = static_cast<int>(i);
    const Eigen::Vector3d x_i = x.col(i);
    Eigen::Vector3d sum = matrix.diagonal(row) * x_i;
    for (int s = matrix.rowBegin(row); s < matrix.rowBegin(row + 1); ++s) {
      const int j = matrix.column(s);
      sum += matrix.lower(s) * x.col(j);
      y.col(j) += matrix.lower(s).transpose() * x_i;
    }
    y.col(i) = sum;
  }
}

}  // namespace

PatchSolver::PatchSolver(const SymmetricBlockMatrix& pattern)
    : kept_(pattern),
      direct_(pattern),
      residual_(3, pattern.size()),
      preconditioned_(3, pattern.size()),
      direction_(3, pattern.size()),
      product_(3, pattern.size()) {}

bool PatchSolver::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                        BlockVector& solution) {
  has_direct_ = false;
  iterations_ = 0;
  if (has_kept_ && iterate(matrix, rhs, kOfStep, kMost, solution)) {
    if (iterations_ > kFew) kept_.renew(matrix, kShare);
    return true;
  }
  has_kept_ = kept_.factorise(matrix);
  if (has_kept_ && iterate(matrix, rhs, kOfStep, kMost, solution)) return true;
  return solveDirectly(matrix, rhs, solution);
}

void PatchSolver::solveAgain(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                             double relative, BlockVector& solution) {
  if (has_direct_) {
    solution = rhs.leftCols(residual_.cols());
    direct_.solve(solution);
    return;
  }
  iterate(matrix, rhs, {relative, 0.0}, kMostAgain, solution);
}

bool PatchSolver::solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                BlockVector& solution) {
  has_kept_ = false;
  has_direct_ = direct_.factorise(matrix);
  if (!has_direct_) return false;
  solution = rhs.leftCols(residual_.cols());
  direct_.solve(solution);
  return solution.allFinite();
}

/// @returns whether the tolerance has been reached within so many iterations
bool PatchSolver::iterate(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                          const Tolerance& tolerance, int most, BlockVector& solution) {
  solution.setZero();
  residual_ = rhs.leftCols(residual_.cols());
  kept_.solve(residual_, preconditioned_);
  direction_ = preconditioned_;
  double energy = residual_.cwiseProduct(preconditioned_).sum();
  const double enough = std::max(tolerance.relative * tolerance.relative * energy, tolerance.energy);
  if (energy == 0.0) return true;
  for (int i = 0; i < most; ++i) {
    if (!(energy > 0.0 && std::isfinite(energy))) return false;
    multiplyLeading(matrix, direction_, product_);
    const double curvature = direction_.cwiseProduct(product_).sum();
    if (!(curvature > 0.0 && std::isfinite(curvature))) return false;
    const double length = energy / curvature;
    solution += length * direction_;
    residual_ -= length * product_;
    ++iterations_;
    kept_.solve(residual_, preconditioned_);
    const double next = residual_.cwiseProduct(preconditioned_).sum();
    if (next <= enough) return true;
    direction_ = preconditioned_ + (next / energy) * direction_;
    energy = next;
  }
  return false;
}

}  // namespace haptex::contact
