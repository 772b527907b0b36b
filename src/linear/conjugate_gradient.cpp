#include "haptex/linear/conjugate_gradient.h"

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "haptex/linear/multigrid.h"
#include "haptex/linear/shared_rows.h"

namespace haptex::linear {

ConjugateGradient::ConjugateGradient(int size, ThreadPool* pool)
    : pool_(pool),
      partial_sums_(sharesOf(size)),
      inverse_diagonal_(size),
      residual_(3, size),
      preconditioned_(3, size),
      direction_(3, size),
      product_(3, size) {}

/// Calls function(first row, number of rows) for parts of all rows.
template <typename Function>
void ConjugateGradient::share(const Function& function) {
  shareRows(pool_, static_cast<int>(residual_.cols()),
            [&](int begin, int end) { function(begin, end - begin); });
}

/// Of function(first row, number of rows) over parts of all rows, in their order.
template <typename Function>
double ConjugateGradient::sum(const Function& function) {
  share([&](int begin, int count) { partial_sums_[begin / kSharedRows] = function(begin, count); });
  return std::accumulate(partial_sums_.begin(), partial_sums_.end(), 0.0);
}

double ConjugateGradient::dot(const BlockVector& a, const BlockVector& b) {
  return sum([&](int begin, int count) {
    return a.middleCols(begin, count).cwiseProduct(b.middleCols(begin, count)).sum();
  });
}

double ConjugateGradient::norm(const BlockVector& a) {
  return std::sqrt(
      sum([&](int begin, int count) { return a.middleCols(begin, count).squaredNorm(); }));
}

SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                     double tolerance, int max_iterations, BlockVector& x,
                                     Patience patience) {
  share([&](int begin, int count) {
    for (int i = begin; i < begin + count; ++i) {
      inverse_diagonal_[i] = matrix.diagonal(i).inverse();
    }
  });
  const auto precondition = [&] {
    share([&](int begin, int count) {
      for (int i = begin; i < begin + count; ++i) {
        preconditioned_.col(i).noalias() = inverse_diagonal_[i] * residual_.col(i);
      }
    });
  };
  return iterate(matrix, precondition, rhs, tolerance, max_iterations, x, patience);
}

template <typename Factor>
SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix& matrix, Factor& factor,
                                     const BlockVector& rhs, double tolerance, int max_iterations,
                                     BlockVector& x, Patience patience) {
  const auto precondition = [&] {
    share([&](int begin, int count) {
      preconditioned_.middleCols(begin, count) = residual_.middleCols(begin, count);
    });
    factor.solve(preconditioned_);
  };
  return iterate(matrix, precondition, rhs, tolerance, max_iterations, x, patience);
}

template <typename Precondition>
SolveResult ConjugateGradient::iterate(const SymmetricBlockMatrix& matrix,
                                       const Precondition& precondition, const BlockVector& rhs,
                                       double tolerance, int max_iterations, BlockVector& x,
                                       Patience patience) {
  SolveResult result;
  const double rhs_norm = norm(rhs);
  if (rhs_norm == 0.0) {
    x.setZero();
    result.converged = true;
    return result;
  }
  const auto restart = [&] {
    matrix.multiply(x, product_, pool_);
    result.residual = std::sqrt(sum([&](int begin, int count) {
                        auto part = residual_.middleCols(begin, count);
                        part = rhs.middleCols(begin, count) - product_.middleCols(begin, count);
                        return part.squaredNorm();
                      })) /
                      rhs_norm;
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
  const double start = result.residual;
  const auto is_slow = [&](double residual) {
    constexpr double kLeastPace = 0.7;
    const double spent = static_cast<double>(result.iterations) / max_iterations;
    return patience == Patience::kWhilePromising && spent >= 0.25 &&
           residual > start * std::pow(tolerance / start, kLeastPace * spent);
  };
  bool given_up = false;
  while (!result.converged && result.iterations < max_iterations) {
    const double before = result.residual;
    precondition();
    double slope = sum([&](int begin, int count) {
      const auto part = preconditioned_.middleCols(begin, count);
      direction_.middleCols(begin, count) = part;
      return residual_.middleCols(begin, count).cwiseProduct(part).sum();
    });
    double recurrence = result.residual;
    while (result.iterations < max_iterations) {
      matrix.multiply(direction_, product_, pool_);
      const double curvature = dot(direction_, product_);
      result.indefinite = !(curvature > 0.0);  // to rounding, or not a number
      if (result.indefinite) break;
      const double step = slope / curvature;
      const double square = sum([&](int begin, int count) {
        x.middleCols(begin, count) += step * direction_.middleCols(begin, count);
        auto part = residual_.middleCols(begin, count);
        part -= step * product_.middleCols(begin, count);
        return part.squaredNorm();
      });
      ++result.iterations;
      recurrence = std::sqrt(square) / rhs_norm;
      given_up = is_slow(recurrence);
      if (recurrence <= tolerance || given_up) break;
      precondition();
      const double next_slope = dot(residual_, preconditioned_);
      share([&](int begin, int count) {
        auto part = direction_.middleCols(begin, count);
        part = preconditioned_.middleCols(begin, count) + (next_slope / slope) * part;
      });
      slope = next_slope;
    }
    restart();
    // Below the rounding of the matrix-vector product another round cannot help.
    if (given_up || !(result.residual < 0.5 * before)) break;
  }
  if (!(result.residual <= 1.0)) {  // diverged: no change at all is nearer to the solution
    x.setZero();
    restart();
  }
  return result;
}

template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&,
                                              BasicBlockCholesky<float>&, const BlockVector&,
                                              double, int, BlockVector&, Patience);
template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&,
                                              BasicBlockCholesky<double>&, const BlockVector&,
                                              double, int, BlockVector&, Patience);
template SolveResult ConjugateGradient::solve(const SymmetricBlockMatrix&, Multigrid&,
                                              const BlockVector&, double, int, BlockVector&,
                                              Patience);

}  // namespace haptex::linear
