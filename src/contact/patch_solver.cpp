#include "haptex/contact/patch_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace haptex::contact {
namespace {

using linear::BlockVector;
using linear::SymmetricBlockMatrix;

// How far an iteration goes: the error e of a solution has the energy e.A e, with increments of
// velocity in J. 1e-14 J in the cloth behind a contact of 1000 N/m change its force by 4.5e-6 N at
// most, a thousandth of what the device's sensors can tell.
constexpr double kRelative = 3e-5;     // error by solution, roots of the energies
constexpr double kEnergy = 1e-14;      // J; enough, however small the solution is
constexpr double kMinReduction = 0.3;  // that is expected of the error's energy

constexpr int kMost = 10;  // iterations, after which a new factor is worth its time

// Of the factor that is renewed in a step. With 0.02, 0.05 and 0.1 after short steps a step takes
// the same time in the mean; its longest hundredth takes 7.5, 6 and 5 iterations (to 5e-14 J).
constexpr double kMinShare = 0.1;
constexpr double kShare = 0.15;

/// y = A x for the leading part.
void multiplyPlainly(const SymmetricBlockMatrix& matrix, const BlockVector& x, BlockVector& y) {
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

#if defined(__x86_64__)
/// The same for processors with AVX2 and FMA.
[[gnu::target("avx2,fma")]] void multiplyWide(const SymmetricBlockMatrix& matrix,
                                              const BlockVector& x, BlockVector& y) {
  const __m256i three = _mm256_set_epi64x(0, -1, -1, -1);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const int row = static_cast<int>(i);
    const double* const at = x.data() + 3 * i;
    const __m256d x_i = _mm256_maskload_pd(at, three);
    const double* const own = matrix.diagonal(row).data();
    __m256d sum = _mm256_loadu_pd(own) * _mm256_set1_pd(at[0]) +
                  _mm256_loadu_pd(own + 3) * _mm256_set1_pd(at[1]) +
                  _mm256_maskload_pd(own + 6, three) * _mm256_set1_pd(at[2]);
    for (int s = matrix.rowBegin(row); s < matrix.rowBegin(row + 1); ++s) {
      const std::ptrdiff_t j = 3 * std::ptrdiff_t{matrix.column(s)};
      const double* const block = matrix.lower(s).data();
      const double* const other = x.data() + j;
      const __m256d b0 = _mm256_loadu_pd(block), b1 = _mm256_loadu_pd(block + 3);
      // Not beyond the block, which may be the last one.
      const __m256d b2 = _mm256_permute4x64_pd(_mm256_loadu_pd(block + 5), 0xf9);
      sum = _mm256_fmadd_pd(b0, _mm256_broadcast_sd(other), sum);
      sum = _mm256_fmadd_pd(b1, _mm256_broadcast_sd(other + 1), sum);
      sum = _mm256_fmadd_pd(b2, _mm256_broadcast_sd(other + 2), sum);
      const __m256d pairs = _mm256_hadd_pd(b0 * x_i, b1 * x_i);
      const __m256d last = _mm256_hadd_pd(b2 * x_i, _mm256_setzero_pd());
      const __m256d low = _mm256_permute2f128_pd(pairs, last, 0x20);
      const __m256d high = _mm256_permute2f128_pd(pairs, last, 0x31);
      double* const to = y.data() + j;
      _mm256_maskstore_pd(to, three, _mm256_maskload_pd(to, three) + (low + high));
    }
    _mm256_maskstore_pd(y.data() + 3 * i, three, sum);
  }
}
#endif

void multiplyLeading(const SymmetricBlockMatrix& matrix, const BlockVector& x, BlockVector& y) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return multiplyWide(matrix, x, y);
#endif
  multiplyPlainly(matrix, x, y);
}

}  // namespace

PatchSolver::PatchSolver(const SymmetricBlockMatrix& pattern)
    : kept_(pattern),
      direct_(pattern),
      residual_(3, pattern.size()),
      preconditioned_(3, pattern.size()),
      direction_(3, pattern.size()),
      product_(3, pattern.size()),
      last_(3, pattern.size()),
      before_last_(3, pattern.size()) {}

bool PatchSolver::solve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                        const Eigen::Vector3d& guess, BlockVector& solution) {
  guess_ = guess;
  has_direct_ = false;
  iterations_ = 0;
  if (!solveByKept(matrix, rhs, solution) && !solveDirectly(matrix, rhs, solution)) {
    solved_ = 0;
    return false;
  }
  std::swap(last_, before_last_);
  last_ = solution;
  solved_ = std::min(solved_ + 1, 2);
  return true;
}

bool PatchSolver::solveByKept(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                              BlockVector& solution) {
  if (has_kept_ && iterate(matrix, rhs, kMost, solution)) {
    kept_.renew(matrix, wasShort() ? kMinShare : kShare);
    return true;
  }
  has_kept_ = kept_.factorise(matrix);
  return has_kept_ && iterate(matrix, rhs, kMost, solution);
}

void PatchSolver::improve(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                          BlockVector& solution) {
  if (has_direct_) {
    solution = rhs.leftCols(residual_.cols());
    direct_.solve(solution);
    return;
  }
  multiplyLeading(matrix, solution, product_);
  residual_ = rhs.leftCols(residual_.cols()) - product_;
  kept_.solve(residual_, direction_);
  addDirection(matrix, residual_.cwiseProduct(direction_).sum(), solution);
}

bool PatchSolver::solveDirectly(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                                BlockVector& solution) {
  has_kept_ = false;
  solved_ = 0;
  has_direct_ = direct_.factorise(matrix);
  if (!has_direct_) return false;
  solution = rhs.leftCols(residual_.cols());
  direct_.solve(solution);
  return solution.allFinite();
}

/// Goes along the direction to where the error is least.
/// @param slope residual times direction (J)
/// @returns how far; not above 0 if the matrix is not positive definite there or not finite
double PatchSolver::addDirection(const SymmetricBlockMatrix& matrix, double slope,
                                 BlockVector& solution) {
  multiplyLeading(matrix, direction_, product_);
  const double curvature = direction_.cwiseProduct(product_).sum();
  const double length = slope / curvature;
  if (!(slope > 0.0 && curvature > 0.0 && std::isfinite(length))) return 0.0;
  solution += length * direction_;
  return length;
}

/// Goes as far as it helps towards what the solutions of the last systems foretell, or in the
/// direction of the guess where there were none. Leaves the residual.
/// @returns the energy that the error has lost (J)
double PatchSolver::foretell(const SymmetricBlockMatrix& matrix, const BlockVector& rhs,
                             BlockVector& solution) {
  solution.setZero();
  residual_ = rhs.leftCols(residual_.cols());
  if (solved_ >= 2) {
    direction_ = 2.0 * last_ - before_last_;
  } else if (!guess_.isZero(0.0)) {
    direction_.colwise() = guess_;
  } else {
    return 0.0;
  }
  const double slope = residual_.cwiseProduct(direction_).sum();
  const double length = addDirection(matrix, slope, solution);
  residual_ -= length * product_;
  return length * slope;
}

/// @returns whether the tolerance has been reached within so many iterations
bool PatchSolver::iterate(const SymmetricBlockMatrix& matrix, const BlockVector& rhs, int most,
                          BlockVector& solution) {
  double solved = foretell(matrix, rhs, solution);
  const auto enough = [&] { return std::max(kRelative * kRelative * solved, kEnergy); };
  kept_.solve(residual_, preconditioned_);
  direction_ = preconditioned_;
  double error = residual_.cwiseProduct(preconditioned_).sum();  // by the old factor's measure
  if (error >= 0.0 && error <= enough()) return true;
  double reduction = kMinReduction;
  for (int i = 0; i < most; ++i) {
    ++iterations_;
    const double length = addDirection(matrix, error, solution);
    if (!(length > 0.0)) return false;
    // By the matrix's own measure this is what the iteration has taken away from the error's
    // energy; the next one would take as much less as this one did.
    const double taken = length * error;
    solved += taken;
    if (taken * std::max(reduction, kMinReduction) <= enough()) return true;
    residual_ -= length * product_;
    kept_.solve(residual_, preconditioned_);
    const double next = residual_.cwiseProduct(preconditioned_).sum();
    if (next == 0.0) return true;
    reduction = next / error;
    direction_ = preconditioned_ + reduction * direction_;
    error = next;
  }
  return false;
}

}  // namespace haptex::contact
