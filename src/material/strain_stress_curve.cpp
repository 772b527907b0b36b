#include "haptex/material/strain_stress_curve.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "haptex/base/require.h"

namespace haptex::material {
namespace {

using Cubic = std::array<double, 4>;

bool allFinite(const Cubic& cubic) {
  return std::all_of(cubic.begin(), cubic.end(), [](double c) { return std::isfinite(c); });
}

double value(const Cubic& c, double x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

double slope(const Cubic& c, double x) { return c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]); }

void requireKnots(const std::vector<double>& knots) {
  if (knots.size() < 2) base::refuse("knots: has ", knots.size(), " numbers, must have at least 2");
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i])) base::refuse("knots[", i, "]: ", knots[i], " is not finite");
    if (i > 0 && knots[i] <= knots[i - 1]) {
      base::refuse("knots[", i, "]: ", knots[i], " must be greater than the one before, ",
                   knots[i - 1]);
    }
  }
}

void requireCoefficients(const std::vector<Cubic>& coefficients, std::size_t intervals) {
  if (coefficients.size() != intervals) {
    base::refuse("coefficients: has ", coefficients.size(),
                 " rows, must have one per interval: ", intervals);
  }
  for (std::size_t i = 0; i < intervals; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!std::isfinite(coefficients[i][k])) {
        base::refuse("coefficients[", i, "][", k, "]: ", coefficients[i][k], " is not finite");
      }
    }
  }
}

struct Magnitudes {
  double stress = 0.0;
  double slope = 0.0;
};

Magnitudes largestAtKnots(const std::vector<double>& knots, const std::vector<Cubic>& rows) {
  Magnitudes largest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const double x : {0.0, knots[i + 1] - knots[i]}) {
      largest.stress = std::max(largest.stress, std::abs(value(rows[i], x)));
      largest.slope = std::max(largest.slope, std::abs(slope(rows[i], x)));
    }
  }
  return largest;
}

// Written so that NaN, which only overflow can bring here, counts as a jump.
void requireContinuity(const std::vector<double>& knots, const std::vector<Cubic>& rows,
                       const Magnitudes& largest) {
  constexpr double kTolerance = StrainStressCurve::kJumpTolerance;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double x = knots[i] - knots[i - 1];
    const double stress_jump = rows[i][0] - value(rows[i - 1], x);
    const double slope_jump = rows[i][1] - slope(rows[i - 1], x);
    if (!(std::abs(stress_jump) <= kTolerance * largest.stress)) {
      base::refuse("knots[", i, "]: the stress jumps by ", stress_jump, " at strain ", knots[i],
                   ", it must be continuous");
    }
    if (!(std::abs(slope_jump) <= kTolerance * largest.slope)) {
      base::refuse("knots[", i, "]: the slope jumps by ", slope_jump, " at strain ", knots[i],
                   ", it must be continuous");
    }
  }
}

// Adds the origin, and the mirror image where the fit is odd.
void completePoints(std::vector<CurvePoint>& points, NegativeBranch negative_branch) {
  const bool only_positive = points.front().strain >= 0.0;
  const auto origin = std::find_if(points.begin(), points.end(),
                                   [](const CurvePoint& point) { return point.strain >= 0.0; });
  if (origin == points.end() || origin->strain > 0.0) points.insert(origin, CurvePoint{0.0, 0.0});
  if (!only_positive || negative_branch != NegativeBranch::kOdd) return;
  std::vector<CurvePoint> mirrored;
  for (auto point = points.rbegin(); point + 1 != points.rend(); ++point) {
    mirrored.push_back({-point->strain, -point->stress});
  }
  points.insert(points.begin(), mirrored.begin(), mirrored.end());
}

// Fritsch and Butland 1984: zero at a turning point, otherwise the harmonic mean of
// the two secant slopes, weighted by the widths; at most three times the smaller one, which is what
// Fritsch and Carlson 1980 require for monotony.
double monotoneSlope(double width_before, double secant_before, double width_after,
                     double secant_after) {
  const bool same_sign =
      (secant_before > 0.0 && secant_after > 0.0) || (secant_before < 0.0 && secant_after < 0.0);
  if (!same_sign) return 0.0;
  const double weight_before = 2.0 * width_after + width_before;
  const double weight_after = width_after + 2.0 * width_before;
  return (weight_before + weight_after) /
         (weight_before / secant_before + weight_after / secant_after);
}

std::vector<double> fitSlopes(const std::vector<CurvePoint>& points) {
  const std::size_t intervals = points.size() - 1;
  std::vector<double> widths(intervals), secants(intervals), slopes(points.size());
  for (std::size_t i = 0; i < intervals; ++i) {
    widths[i] = points[i + 1].strain - points[i].strain;
    secants[i] = (points[i + 1].stress - points[i].stress) / widths[i];
  }
  slopes.front() = secants.front();
  slopes.back() = secants.back();
  for (std::size_t i = 1; i < intervals; ++i) {
    slopes[i] = monotoneSlope(widths[i - 1], secants[i - 1], widths[i], secants[i]);
  }
  return slopes;
}

Cubic hermite(const CurvePoint& begin, double begin_slope, const CurvePoint& end,
              double end_slope) {
  const double width = end.strain - begin.strain;
  const double secant = (end.stress - begin.stress) / width;
  return {begin.stress, begin_slope, (3.0 * secant - 2.0 * begin_slope - end_slope) / width,
          (begin_slope + end_slope - 2.0 * secant) / (width * width)};
}

}  // namespace

void requireFitPoints(const std::vector<CurvePoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [strain, stress] = points[i];
    if (!std::isfinite(strain)) base::refuse("points[", i, "]: strain ", strain, " is not finite");
    if (!std::isfinite(stress)) base::refuse("points[", i, "]: stress ", stress, " is not finite");
    if (i > 0 && strain <= points[i - 1].strain) {
      base::refuse("points[", i, "]: strain ", strain, " must be greater than the one before, ",
                   points[i - 1].strain);
    }
    if (strain == 0.0 && stress != 0.0) {
      base::refuse("points[", i, "]: stress ", stress, " at strain 0 must be 0");
    }
  }
  if (std::none_of(points.begin(), points.end(),
                   [](const CurvePoint& point) { return point.strain != 0.0; })) {
    base::refuse("points: has ", points.size(),
                 " points, must have at least one at a strain other than 0");
  }
}

StrainStressCurve::StrainStressCurve() : StrainStressCurve({0.0, 1.0}, {Cubic{}}) {}

StrainStressCurve StrainStressCurve::linear(double modulus) {
  if (!std::isfinite(modulus) || modulus < 0.0) {
    base::refuse("modulus: ", modulus, " must be finite and >= 0");
  }
  return StrainStressCurve({0.0, 1.0}, {Cubic{0.0, modulus, 0.0, 0.0}});
}

StrainStressCurve StrainStressCurve::fromPolynomials(const std::vector<double>& knots,
                                                     const std::vector<Cubic>& coefficients) {
  requireKnots(knots);
  requireCoefficients(coefficients, knots.size() - 1);
  const Magnitudes largest = largestAtKnots(knots, coefficients);
  if (!std::isfinite(largest.stress) || !std::isfinite(largest.slope)) {
    base::refuse("coefficients: the curve is too steep or too large for double arithmetic");
  }
  requireContinuity(knots, coefficients, largest);
  StrainStressCurve curve(knots, coefficients);
  const double stress_at_zero = curve.evaluate(0.0).stress;
  if (!(std::abs(stress_at_zero) <= kJumpTolerance * largest.stress)) {
    base::refuse("coefficients: the stress at strain 0 is ", stress_at_zero, ", it must be 0");
  }
  return curve;
}

StrainStressCurve StrainStressCurve::fit(std::vector<CurvePoint> points,
                                         NegativeBranch negative_branch) {
  requireFitPoints(points);
  completePoints(points, negative_branch);
  const std::vector<double> slopes = fitSlopes(points);
  std::vector<double> knots;
  std::vector<Cubic> coefficients;
  for (const CurvePoint& point : points) knots.push_back(point.strain);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    coefficients.push_back(hermite(points[i], slopes[i], points[i + 1], slopes[i + 1]));
  }
  return StrainStressCurve(knots, coefficients);
}

StrainStressCurve::StrainStressCurve(const std::vector<double>& knots,
                                     const std::vector<Cubic>& coefficients)
    : knots_(knots) {
  segments_.push_back({knots.front(), {coefficients[0][0], coefficients[0][1], 0.0, 0.0}, 0.0});
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    segments_.push_back({knots[i], coefficients[i], 0.0});
  }
  const double x = knots.back() - knots[knots.size() - 2];
  const Cubic& last = coefficients.back();
  segments_.push_back({knots.back(), {value(last, x), slope(last, x), 0.0, 0.0}, 0.0});
  makeBins();
  integrateEnergy();
  for (const Segment& segment : segments_) {
    if (!allFinite(segment.coefficients) || !std::isfinite(segment.energy_at_begin)) {
      base::refuse("the curve near strain ", segment.begin,
                   " is too steep or too large for double arithmetic");
    }
  }
}

// A bin starts its search at the number of knots in the bins before it. As binIndex() is monotone,
// every strain of the bin lies beyond those knots, so the search never starts too late; it ends
// before the last knot because segmentIndex() has dealt with larger strains. The bin of the last
// knot itself is the spare that a strain just below it may round into.
void StrainStressCurve::makeBins() {
  const double range = knots_.back() - knots_.front();
  double narrowest = range;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    narrowest = std::min(narrowest, knots_[i] - knots_[i - 1]);
  }
  const double bins = std::min(std::ceil(range / narrowest), static_cast<double>(kMaxBins));
  bins_per_strain_ = bins / range;
  if (!std::isfinite(range) || !std::isfinite(bins_per_strain_)) {
    base::refuse("the range of strains from ", knots_.front(), " to ", knots_.back(),
                 " is too wide or too narrow for double arithmetic");
  }
  first_segment_of_bin_.assign(binIndex(knots_.back()) + 1, 0);
  std::size_t knots_before = 0;
  for (std::size_t bin = 0; bin < first_segment_of_bin_.size(); ++bin) {
    while (binIndex(knots_[knots_before]) < bin) ++knots_before;
    first_segment_of_bin_[bin] = knots_before;
  }
}

// Sums outwards from strain 0, so that small strains keep their relative accuracy.
void StrainStressCurve::integrateEnergy() {
  const std::size_t zero = segmentIndex(0.0);
  segments_[zero].energy_at_begin = -energyFromBegin(zero, 0.0);
  for (std::size_t i = zero + 1; i < segments_.size(); ++i) {
    segments_[i].energy_at_begin =
        segments_[i - 1].energy_at_begin + energyFromBegin(i - 1, segments_[i].begin);
  }
  for (std::size_t i = zero; i-- > 0;) {
    segments_[i].energy_at_begin =
        segments_[i + 1].energy_at_begin - energyFromBegin(i, segments_[i + 1].begin);
  }
}

StrainStressCurve StrainStressCurve::scaledBy(double factor) const {
  StrainStressCurve scaled = *this;
  for (Segment& segment : scaled.segments_) {
    for (double& coefficient : segment.coefficients) coefficient *= factor;
    segment.energy_at_begin *= factor;
  }
  return scaled;
}

bool StrainStressCurve::isZero() const {
  return std::all_of(segments_.begin(), segments_.end(),
                     [](const Segment& segment) { return segment.coefficients == Cubic{}; });
}

double StrainStressCurve::minimumSlope() const {
  double minimum = segments_.back().coefficients[1];
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const Cubic& c = segments_[i].coefficients;
    const double width = knots_[i] - knots_[i - 1];
    minimum = std::min({minimum, slope(c, 0.0), slope(c, width)});
    if (c[3] == 0.0) continue;
    const double vertex = -c[2] / (3.0 * c[3]);  // of the parabola that the slope is
    if (vertex > 0.0 && vertex < width) minimum = std::min(minimum, slope(c, vertex));
  }
  return minimum;
}

double StrainStressCurve::firstKnot() const { return knots_.front(); }

double StrainStressCurve::lastKnot() const { return knots_.back(); }

}  // namespace haptex::material
