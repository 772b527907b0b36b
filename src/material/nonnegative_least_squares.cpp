#include "haptex/material/nonnegative_least_squares.h"

#include <Eigen/QR>
#include <limits>
#include <stdexcept>
#include <vector>

#include "haptex/base/require.h"

namespace haptex::material {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void requireSystem(const MatrixXd& matrix, const VectorXd& right_side) {
  if (matrix.cols() == 0 || matrix.rows() < matrix.cols() || matrix.rows() != right_side.size()) {
    base::refuse("nonnegativeLeastSquares: a matrix of ", matrix.rows(), " x ", matrix.cols(),
                 " and ", right_side.size(),
                 " numbers; there must be a number per row and no fewer rows than columns");
  }
  if (!matrix.allFinite() || !right_side.allFinite()) {
    base::refuse("nonnegativeLeastSquares: a number is not finite");
  }
}

/// The least squares of the free unknowns alone; the others are 0.
VectorXd solveFree(const MatrixXd& matrix, const VectorXd& right_side,
                   const std::vector<bool>& free) {
  std::vector<Eigen::Index> columns;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i]) columns.push_back(static_cast<Eigen::Index>(i));
  }
  VectorXd solution = VectorXd::Zero(matrix.cols());
  const MatrixXd part = matrix(Eigen::all, columns);
  solution(columns) = part.colPivHouseholderQr().solve(right_side);
  return solution;
}

/// The held unknown along which the sum of squares falls most, or -1 if it falls along none.
Eigen::Index steepest(const VectorXd& descent, const std::vector<bool>& free,
                      const std::vector<bool>& barred, double tolerance) {
  Eigen::Index best = -1;
  for (Eigen::Index i = 0; i < descent.size(); ++i) {
    if (free[i] || barred[i] || descent(i) <= tolerance) continue;
    if (best < 0 || descent(i) > descent(best)) best = i;
  }
  return best;
}

/// Moves x to the least squares of the free unknowns; those that would become negative on the way
/// stop at 0 and are held.
void minimiseFree(const MatrixXd& matrix, const VectorXd& right_side, VectorXd& x,
                  std::vector<bool>& free) {
  while (true) {
    const VectorXd solution = solveFree(matrix, right_side, free);
    double part = 1.0;
    Eigen::Index first = -1;  // to become 0
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (!free[i] || solution(i) > 0.0) continue;
      const double until = x(i) > 0.0 ? x(i) / (x(i) - solution(i)) : 0.0;
      if (first >= 0 && until >= part) continue;
      part = until;
      first = i;
    }
    x += part * (solution - x);
    if (first < 0) return;
    free[first] = false;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (!free[i] || x(i) < 0.0) x(i) = 0.0;
    }
  }
}

}  // namespace

VectorXd nonnegativeLeastSquares(const MatrixXd& matrix, const VectorXd& right_side) {
  requireSystem(matrix, right_side);
  // The same sum of squares but for a constant, with as many rows as unknowns.
  const Eigen::Index unknowns = matrix.cols();
  const Eigen::HouseholderQR<MatrixXd> qr(matrix);
  const MatrixXd square = qr.matrixQR().topRows(unknowns).triangularView<Eigen::Upper>();
  const VectorXd projected = (qr.householderQ().transpose() * right_side).head(unknowns);

  const double tolerance = 100.0 * std::numeric_limits<double>::epsilon() *
                           square.colwise().norm().maxCoeff() * projected.norm();
  VectorXd x = VectorXd::Zero(unknowns);
  std::vector<bool> free(unknowns, false), barred(unknowns, false);
  for (Eigen::Index i = 0; i < 30 * unknowns; ++i) {
    const VectorXd descent = square.transpose() * (projected - square * x);
    const Eigen::Index entering = steepest(descent, free, barred, tolerance);
    if (entering < 0) return x;
    free[entering] = true;
    const VectorXd before = x;
    minimiseFree(square, projected, x, free);
    // By rounding alone an unknown may seem to help and does not: until x moves it stays held.
    if (x == before) {
      barred[entering] = true;
    } else {
      barred.assign(unknowns, false);
    }
  }
  throw std::runtime_error("nonnegativeLeastSquares: the active set does not settle");
}

}  // namespace haptex::material
