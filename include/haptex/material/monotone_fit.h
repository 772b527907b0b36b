// Rising curves through noisy samples, by constrained least squares.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/material/strain_stress_curve.h"

namespace haptex::material {

/// A C1 piecewise cubic as StrainStressCurve::fromPolynomials() takes it: n + 1 knots, n rows.
struct PiecewiseCubic {
  std::vector<double> knots;
  std::vector<std::array<double, 4>> coefficients;

  /// Beyond the knots straight on.
  double evaluate(double x) const;
};

/// The curve whose values at -x are the negative ones. @param cubic first knot and value there 0
PiecewiseCubic withMirrorImage(const PiecewiseCubic& cubic);

/// How far samples are from a curve, in the unit of the samples.
struct Residuals {
  double rms = 0.0;
  double largest = 0.0;
  double scale = 0.0;  ///< the largest magnitude of the samples, to which percents refer
};

Residuals residualsOf(const PiecewiseCubic& curve, const std::vector<CurvePoint>& samples);

/// The rising C1 piecewise cubics over given knots as sums of functions with parameters >= 0,
/// beside their value at the first knot. They are integrated splines (Ramsay 1988, Statistical
/// Science 3:425) with double knots: each is the sum of all cubic B-splines from one on, so that
/// parameters
/// >= 0 make the coefficients of the B-splines, and with them the curve, rise. At the first knot,
/// from where the curve goes on as a straight line, it has no curvature: with that the slope at
/// rest comes out up to four times surer of the same noisy readings. The ends are kept from being
/// level: they have at least about kLeastEndSlope of the mean slope of their piece, unless all of
/// it is level. n pieces have 2n functions.
class MonotoneBasis {
 public:
  static constexpr double kLeastEndSlope = 0.1;

  /// @param knots at least two, strictly increasing, finite
  /// @throws std::invalid_argument naming the knot otherwise
  explicit MonotoneBasis(std::vector<double> knots);

  Eigen::Index size() const { return to_increments_.cols(); }

  /// The functions at x, which are 0 at the first knot; beyond the knots they go straight on.
  Eigen::RowVectorXd at(double x) const;

  /// The curve of parameters (size() numbers >= 0) with that value at the first knot.
  PiecewiseCubic curve(const Eigen::VectorXd& parameters, double first_value = 0.0) const;

 private:
  Eigen::RowVectorXd splinesAt(double x) const;

  std::vector<double> knots_;
  Eigen::MatrixXd to_increments_;  // of the B-splines' coefficients from the parameters
};

/// `first`, and on from there `pieces` knots between which equally many of the different values of
/// x lie; the last is the largest.
/// @param x finite, those greater than `first` count @param pieces at least 1
/// @throws std::invalid_argument naming how many values there are and how many pieces they allow:
///   there must be 2 pieces + 2 of them
std::vector<double> quantileKnots(const std::vector<double>& x, double first, int pieces);

/// Rows of `matrix` and `right_side` weighted so that least squares weigh relative deviations, from
/// kWeightFloor of the largest value on: testers are read to a share of the reading, and cloth
/// hangs and folds at small stresses.
constexpr double kWeightFloor = 0.02;

/// Nonnegative least squares of rows that are weighted by 1 / (value + kWeightFloor largest value)
/// with the value that an unweighted fit has there: weights from the readings themselves would
/// favour those that are too small.
/// @throws as nonnegativeLeastSquares()
Eigen::VectorXd relativeLeastSquares(const Eigen::MatrixXd& matrix,
                                     const Eigen::VectorXd& right_side);

/// The rising C1 curve of `pieces` cubics from the origin that deviates least from the samples, by
/// relativeLeastSquares(); knots by quantileKnots().
/// @param samples at strains >= 0, in any order, several at one strain allowed
/// @throws std::invalid_argument naming a sample by index that is not finite or at a strain < 0,
/// too
///   few samples, or a first or last piece over which the samples do not rise
PiecewiseCubic fitMonotone(const std::vector<CurvePoint>& samples, int pieces);

/// What fitMonotone() asks of a curve: that its first and last piece rise.
/// @throws std::invalid_argument naming the piece
void requireRisingEnds(const PiecewiseCubic& curve);

}  // namespace haptex::material
