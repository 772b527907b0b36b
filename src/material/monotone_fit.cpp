#include "haptex/material/monotone_fit.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"
#include "haptex/material/nonnegative_least_squares.h"

namespace haptex::material {
namespace {

using Cubic = std::array<double, 4>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Of an end's increment to those beside it. Where they are all that the piece rises by, the slope
// at the end is 3 kShare / (1 + kShare) of the piece's mean slope.
constexpr double kShare = MonotoneBasis::kLeastEndSlope / (3.0 - MonotoneBasis::kLeastEndSlope);

double value(const Cubic& c, double x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

double slope(const Cubic& c, double x) { return c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]); }

/// The piece of x; the first and last also of what lies beyond.
std::size_t pieceOf(const std::vector<double>& knots, double x) {
  const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
  return static_cast<std::size_t>(after - knots.begin()) - 1;
}

/// Bernstein's polynomials of degree 3 at t, and beyond 0 to 1 their tangents at the ends.
Eigen::Array4d bernstein(double t) {
  const double inside = std::clamp(t, 0.0, 1.0), s = 1.0 - inside;
  Eigen::Array4d result(s * s * s, 3.0 * inside * s * s, 3.0 * inside * inside * s,
                        inside * inside * inside);
  if (t < 0.0) result += t * Eigen::Array4d(-3.0, 3.0, 0.0, 0.0);
  if (t > 1.0) result += (t - 1.0) * Eigen::Array4d(0.0, 0.0, -3.0, 3.0);
  return result;
}

}  // namespace

double PiecewiseCubic::evaluate(double x) const {
  const std::size_t i = pieceOf(knots, x);
  const double inside = std::clamp(x, knots.front(), knots.back());
  return value(coefficients[i], inside - knots[i]) +
         (x - inside) * slope(coefficients[i], inside - knots[i]);
}

PiecewiseCubic withMirrorImage(const PiecewiseCubic& cubic) {
  PiecewiseCubic both;
  for (std::size_t i = cubic.coefficients.size(); i-- > 0;) {
    const Cubic& c = cubic.coefficients[i];
    const double width = cubic.knots[i + 1] - cubic.knots[i];
    both.knots.push_back(-cubic.knots[i + 1]);
    both.coefficients.push_back(
        {-value(c, width), slope(c, width), -(c[2] + 3.0 * c[3] * width), c[3]});
  }
  both.knots.insert(both.knots.end(), cubic.knots.begin(), cubic.knots.end());
  both.coefficients.insert(both.coefficients.end(), cubic.coefficients.begin(),
                           cubic.coefficients.end());
  return both;
}

Residuals residualsOf(const PiecewiseCubic& curve, const std::vector<CurvePoint>& samples) {
  Residuals residuals;
  double squares = 0.0;
  for (const auto& [strain, stress] : samples) {
    const double residual = stress - curve.evaluate(strain);
    squares += residual * residual;
    residuals.largest = std::max(residuals.largest, std::abs(residual));
    residuals.scale = std::max(residuals.scale, std::abs(stress));
  }
  if (!samples.empty()) residuals.rms = std::sqrt(squares / samples.size());
  return residuals;
}

MonotoneBasis::MonotoneBasis(std::vector<double> knots) : knots_(std::move(knots)) {
  if (knots_.size() < 2) base::refuse("knots: has ", knots_.size(), ", must have at least 2");
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    if (!std::isfinite(knots_[i]) || (i > 0 && knots_[i] <= knots_[i - 1])) {
      base::refuse("knots[", i, "]: ", knots_[i],
                   " must be finite and greater than the one before");
    }
  }
  // The first parameter is the increment of the first two coefficients alike: no curvature there.
  const Index increments = 2 * static_cast<Index>(knots_.size()) - 1;
  to_increments_ = MatrixXd::Zero(increments, increments - 1);
  to_increments_.bottomRows(increments - 1).setIdentity();
  to_increments_.row(0) = to_increments_.row(1);
  to_increments_(0, 1) = to_increments_(1, 1) = kShare;
  to_increments_(increments - 1, increments - 3) = kShare;
  if (increments > 3) to_increments_(increments - 1, increments - 4) = kShare;
}

// Coefficients 2i + 1 and 2i + 2 of the B-splines are the inner Bezier ordinates of piece i, and a
// C1 curve has at a knot what the straight line between the ordinates on both sides has there.
RowVectorXd MonotoneBasis::splinesAt(double x) const {
  const std::size_t pieces = knots_.size() - 1, i = pieceOf(knots_, x);
  const auto width = [&](std::size_t piece) { return knots_[piece + 1] - knots_[piece]; };
  const Eigen::Array4d ordinates = bernstein((x - knots_[i]) / width(i));
  RowVectorXd splines = RowVectorXd::Zero(2 * static_cast<Index>(pieces) + 2);
  const auto add_knot = [&](std::size_t knot, double ordinate) {
    const Index before = 2 * static_cast<Index>(knot);
    if (knot == 0) {
      splines(0) += ordinate;
    } else if (knot == pieces) {
      splines(before + 1) += ordinate;
    } else {
      const double share = width(knot) / (width(knot - 1) + width(knot));
      splines(before) += share * ordinate;
      splines(before + 1) += (1.0 - share) * ordinate;
    }
  };
  add_knot(i, ordinates(0));
  splines(2 * static_cast<Index>(i) + 1) += ordinates(1);
  splines(2 * static_cast<Index>(i) + 2) += ordinates(2);
  add_knot(i + 1, ordinates(3));
  return splines;
}

RowVectorXd MonotoneBasis::at(double x) const {
  RowVectorXd sums = splinesAt(x).tail(to_increments_.rows());  // each of itself and all after it
  for (Index i = sums.size() - 1; i-- > 0;) sums(i) += sums(i + 1);
  return sums * to_increments_;
}

PiecewiseCubic MonotoneBasis::curve(const VectorXd& parameters, double first_value) const {
  const VectorXd increments = to_increments_ * parameters;
  VectorXd b(increments.size() + 1);  // coefficients of the B-splines
  b(0) = first_value;
  for (Index i = 0; i < increments.size(); ++i) b(i + 1) = b(i) + increments(i);
  PiecewiseCubic curve{knots_, {}};
  const auto at_knot = [&](std::size_t knot) { return splinesAt(knots_[knot]).dot(b); };
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double width = knots_[i + 1] - knots_[i];
    const double b0 = i == 0 ? first_value : at_knot(i), b3 = at_knot(i + 1);
    const double b1 = b(2 * static_cast<Index>(i) + 1), b2 = b(2 * static_cast<Index>(i) + 2);
    curve.coefficients.push_back({b0, 3.0 * (b1 - b0) / width,
                                  3.0 * (b0 - 2.0 * b1 + b2) / (width * width),
                                  (b3 - 3.0 * b2 + 3.0 * b1 - b0) / (width * width * width)});
  }
  return curve;
}

std::vector<double> quantileKnots(const std::vector<double>& x, double first, int pieces) {
  base::require(pieces >= 1, "quantileKnots", "pieces", pieces, "at least 1");
  std::vector<double> values;
  std::copy_if(x.begin(), x.end(), std::back_inserter(values),
               [&](double at) { return at > first; });
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const std::size_t needed = 2 * static_cast<std::size_t>(pieces) + 2;
  if (values.size() < needed) {
    const std::string have = std::to_string(values.size()) + " different readings";
    if (values.size() < 4) base::refuse("has ", have, ", must have at least 4");
    base::refuse("has ", have, ", ", pieces, " pieces need ", needed, ": at most ",
                 values.size() / 2 - 1, " pieces are allowed");
  }
  values.insert(values.begin(), first);
  std::vector<double> knots;
  for (int i = 0; i <= pieces; ++i) {
    const double place = static_cast<double>(values.size() - 1) * i / pieces;
    const auto below = std::min(static_cast<std::size_t>(place), values.size() - 2);
    knots.push_back(values[below] + (place - below) * (values[below + 1] - values[below]));
  }
  return knots;
}

VectorXd relativeLeastSquares(const MatrixXd& matrix, const VectorXd& right_side) {
  const VectorXd fitted = matrix * nonnegativeLeastSquares(matrix, right_side);
  const double largest = fitted.cwiseAbs().maxCoeff();
  if (largest == 0.0) return VectorXd::Zero(matrix.cols());
  const VectorXd weights =
      (fitted.array().abs() + kWeightFloor * largest).inverse().matrix() * largest;
  return nonnegativeLeastSquares(weights.asDiagonal() * matrix, weights.cwiseProduct(right_side));
}

PiecewiseCubic fitMonotone(const std::vector<CurvePoint>& samples, int pieces) {
  std::vector<double> strains;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [strain, stress] = samples[i];
    if (!std::isfinite(strain) || strain < 0.0) {
      base::refuse("samples[", i, "]: strain ", strain, " must be finite and >= 0");
    }
    if (!std::isfinite(stress)) base::refuse("samples[", i, "]: stress ", stress, " is not finite");
    strains.push_back(strain);
  }
  const MonotoneBasis basis(quantileKnots(strains, 0.0, pieces));
  MatrixXd rows(samples.size(), basis.size());
  VectorXd stresses(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    rows.row(i) = basis.at(samples[i].strain);
    stresses(i) = samples[i].stress;
  }
  const PiecewiseCubic curve = basis.curve(relativeLeastSquares(rows, stresses));
  requireRisingEnds(curve);
  return curve;
}

void requireRisingEnds(const PiecewiseCubic& curve) {
  for (const std::size_t i : {std::size_t{0}, curve.coefficients.size() - 1}) {
    const double begin = curve.knots[i], end = curve.knots[i + 1];
    if (curve.evaluate(end) > curve.evaluate(begin)) continue;
    base::refuse("does not rise from ", begin, " to ", end,
                 ", with whose slope the curve goes on: leave out slack or what is torn, or allow "
                 "fewer pieces");
  }
}

}  // namespace haptex::material
