#include "haptex/material/tester_fits.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "haptex/base/require.h"
#include "haptex/material/kes_conditions.h"
#include "haptex/material/nonnegative_least_squares.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFirstAngle = 0.5, kLastAngle = 5.0;                                // degrees
constexpr std::array<double, 4> kWidthAngles = {kFirstAngle, 2.0, 3.5, kLastAngle};  // degrees
constexpr double kLeastCurvature = 50.0, kMostCurvature = 150.0;                     // 1/m
constexpr double kReach = 0.02;  // by which readings of pressure may miss the ends
constexpr int kPointsPerPiece = 6;

void requireLoading(const ReadingLoop& loop) {
  if (loop.loading.empty()) base::refuse("has no readings of the branch loading");
}

double trapezoid(std::vector<CurvePoint> points) {
  std::stable_sort(points.begin(), points.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.strain < b.strain; });
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum +=
        0.5 * (points[i].stress + points[i - 1].stress) * (points[i].strain - points[i - 1].strain);
  }
  return sum;
}

std::vector<CurvePoint> pointsOf(const std::vector<Reading>& readings) {
  std::vector<CurvePoint> points;
  for (const Reading& reading : readings) points.push_back({reading.x, reading.y});
  return points;
}

/// Both sides as one.
Reading folded(const Reading& reading) {
  return {std::abs(reading.x), std::copysign(1.0, reading.x) * reading.y, reading.line};
}

/// How much the width of the loop at each of kWidthAngles counts at an angle.
Eigen::RowVectorXd widthShares(double angle) {
  Eigen::RowVectorXd shares = Eigen::RowVectorXd::Zero(kWidthAngles.size());
  const double inside = std::clamp(angle, kFirstAngle, kLastAngle);
  std::size_t i = 0;
  while (i + 2 < kWidthAngles.size() && inside > kWidthAngles[i + 1]) ++i;
  const double part = (inside - kWidthAngles[i]) / (kWidthAngles[i + 1] - kWidthAngles[i]);
  shares(static_cast<Index>(i)) = 1.0 - part;
  shares(static_cast<Index>(i) + 1) = part;
  return shares;
}

/// A reading of shear: above or below the middle of the loop by half of its width.
struct ShearReading {
  double strain;
  double stress;
  double angle;  // degrees, >= 0
  double side;   // 1 loading, -1 unloading, 0 if the width is not looked for
};

std::vector<ShearReading> shearReadings(const std::vector<ShearedSample>& samples,
                                        const std::optional<ShearHysteresis>& stated, bool loops) {
  std::vector<ShearReading> result;
  for (const ShearedSample& sample : samples) {
    const ReadingLoop& loop = sample.loop;
    requireLoading(loop);
    const auto add = [&](const Reading& raw, double side) {
      Reading reading = folded(raw);
      if (stated && !loops) {
        const double part =
            std::clamp((reading.x - kFirstAngle) / (kLastAngle - kFirstAngle), 0., 1.);
        reading.y -= 0.5 * ((1.0 - part) * stated->at_half_degree + part * stated->at_five_degrees);
      }
      const bool slips = loops || stated;
      if (slips && reading.x < kFirstAngle * (1.0 - 1e-9)) return;
      if (side < 0.0 && reading.x > kLastAngle * (1.0 + 1e-9)) return;
      result.push_back(
          {exactShearStrain(sample.pulled, reading.x), reading.y, reading.x, loops ? side : 0.0});
    };
    for (const Reading& reading : loop.loading) add(reading, 1.0);
    for (const Reading& reading : loop.unloading) add(reading, -1.0);
  }
  return result;
}

/// Unloading branches or none, and if there are, up to the angle of 2HG5.
bool haveLoops(const std::vector<ShearedSample>& samples) {
  std::size_t loops = 0;
  for (const auto& [loop, pulled] : samples) {
    if (loop.unloading.empty()) continue;
    ++loops;
    double largest = 0.0;
    for (const Reading& reading : loop.loading) largest = std::max(largest, std::abs(reading.x));
    if (largest < kLastAngle) {
      base::refuse("reaches ", largest,
                   " degrees; a loop must reach 5 degrees, where 2HG5 is read");
    }
  }
  if (loops != 0 && loops != samples.size()) {
    base::refuse("has unloading readings of one direction only; both or none must have them");
  }
  return loops != 0;
}

/// y = offset + slope x of a branch in the window of curvature.
struct Line {
  double offset, slope;
};

Line bendingLine(const std::vector<Reading>& branch, const char* name,
                 std::vector<CurvePoint>& used) {
  std::vector<CurvePoint> points;
  for (const Reading& raw : branch) {
    const Reading reading = folded(raw);
    const double tolerance = 1e-9 * kMostCurvature;
    if (reading.x < kLeastCurvature - tolerance || reading.x > kMostCurvature + tolerance) continue;
    points.push_back({reading.x, reading.y});
  }
  const auto [least, most] = std::minmax_element(
      points.begin(), points.end(),
      [](const CurvePoint& a, const CurvePoint& b) { return a.strain < b.strain; });
  if (points.empty() || least->strain == most->strain) {
    base::refuse("must have readings of the branch ", name,
                 " at two or more curvatures from 50 to 150 1/m, has ", points.size());
  }
  MatrixXd rows(points.size(), 2);
  VectorXd moments(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows.row(i) << 1.0, points[i].strain;
    moments(i) = points[i].stress;
  }
  const Eigen::Vector2d line = rows.colPivHouseholderQr().solve(moments);
  for (const CurvePoint& point : points) {
    used.push_back({point.strain, point.stress - line(0) - line(1) * point.strain});
  }
  return {line(0), line(1)};
}

double thicknessAt(const Compression& compression, double pressure) {
  double low = 0.0, high = 1.0;  // compressive strain
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (compression.pressure.evaluate(middle).stress < pressure ? low : high) = middle;
  }
  return compression.thickness * (1.0 - high);
}

/// Thickness, negative so that it rises, over the logarithm of pressure.
PiecewiseCubic fitThickness(const std::vector<CurvePoint>& samples, int pieces) {
  std::vector<double> logarithms;
  double first = std::log(kMaxFittedPressure), thickest = 0.0;
  for (const auto& [logarithm, negative_thickness] : samples) {
    logarithms.push_back(logarithm);
    first = std::min(first, logarithm);
    thickest = std::max(thickest, -negative_thickness);
  }
  const MonotoneBasis basis(quantileKnots(logarithms, first, pieces));
  // The value at the first knot is an unknown >= 0, too, measured from far below.
  const double below = -2.0 * thickest;
  MatrixXd rows(samples.size(), basis.size() + 1);
  VectorXd values(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    rows.row(i) << 1.0, basis.at(samples[i].strain);
    values(i) = samples[i].stress - below;
  }
  const VectorXd solution = nonnegativeLeastSquares(rows, values);
  return basis.curve(solution.tail(basis.size()), solution(0) + below);
}

std::vector<ThicknessPoint> thicknessPoints(const PiecewiseCubic& fit) {
  const double begin = std::log(kKesLowPressure);
  std::vector<double> logarithms = {begin, std::log(kKesHighPressure)};
  for (std::size_t i = 0; i + 1 < fit.knots.size(); ++i) {
    for (int k = 1; k <= kPointsPerPiece; ++k) {
      const double at = fit.knots[i] + (fit.knots[i + 1] - fit.knots[i]) * k / kPointsPerPiece;
      const bool near_end =
          std::abs(at - logarithms[0]) < 0.01 || std::abs(at - logarithms[1]) < 0.01;
      if (at > begin && !near_end) logarithms.push_back(at);
    }
  }
  std::sort(logarithms.begin(), logarithms.end());
  const double t0 = -fit.evaluate(begin);
  constexpr double kStep = 1e-4;
  const double slope = (fit.evaluate(begin + kStep) - fit.evaluate(begin - kStep)) / (2.0 * kStep);
  std::vector<ThicknessPoint> points = {{0.0, t0 + slope}};
  for (const double logarithm : logarithms) {
    const double thickness = -fit.evaluate(logarithm);
    if (thickness < points.back().thickness) points.push_back({std::exp(logarithm), thickness});
  }
  return points;
}

/// Pressure of the unloading branch at a thickness: straight between the readings.
double unloadingPressure(const std::vector<CurvePoint>& by_thickness, double thickness) {
  const auto after =
      std::lower_bound(by_thickness.begin(), by_thickness.end(), thickness,
                       [](const CurvePoint& point, double at) { return point.strain < at; });
  if (after == by_thickness.begin()) return by_thickness.front().stress;
  if (after == by_thickness.end()) return by_thickness.back().stress;
  const CurvePoint &a = *(after - 1), &b = *after;
  return a.stress + (b.stress - a.stress) * (thickness - a.strain) / (b.strain - a.strain);
}

}  // namespace

ElasticFit fitTensile(const ReadingLoop& loop, int pieces) {
  requireLoading(loop);
  const std::vector<CurvePoint> points = curvePointsFromTester(pointsOf(loop.loading));
  const PiecewiseCubic curve = fitMonotone(points, pieces);
  return {curve, points.size(), residualsOf(curve, points)};
}

std::optional<double> tensileResilience(const ReadingLoop& loop) {
  if (loop.unloading.empty()) return std::nullopt;
  requireLoading(loop);
  std::vector<CurvePoint> loading = pointsOf(loop.loading), unloading = pointsOf(loop.unloading);
  const CurvePoint turn = *std::max_element(
      loading.begin(), loading.end(),
      [](const CurvePoint& a, const CurvePoint& b) { return a.strain < b.strain; });
  loading.push_back({0.0, 0.0});
  unloading.push_back({0.0, 0.0});
  unloading.push_back(turn);
  return trapezoid(unloading) / trapezoid(loading);
}

ShearFit fitShear(const std::vector<ShearedSample>& samples,
                  const std::optional<ShearHysteresis>& stated, int pieces) {
  const bool loops = haveLoops(samples);
  const std::vector<ShearReading> readings = shearReadings(samples, stated, loops);
  std::vector<double> strains;
  for (const ShearReading& reading : readings) strains.push_back(reading.strain);
  const MonotoneBasis basis(quantileKnots(strains, 0.0, pieces));
  const Index widths = loops ? static_cast<Index>(kWidthAngles.size()) : 0;
  MatrixXd rows(readings.size(), basis.size() + widths);
  VectorXd stresses(readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const ShearReading& reading = readings[i];
    rows.row(i).head(basis.size()) = basis.at(reading.strain);
    if (loops) rows.row(i).tail(widths) = 0.5 * reading.side * widthShares(reading.angle);
    stresses(i) = reading.stress;
  }
  const VectorXd solution = relativeLeastSquares(rows, stresses);
  ShearFit fit{{basis.curve(solution.head(basis.size())), readings.size(), {}}, stated};
  requireRisingEnds(fit.elastic.curve);
  if (loops) fit.hysteresis = {solution(basis.size()), solution(solution.size() - 1)};
  std::vector<CurvePoint> middle;  // readings, taken to the middle of the loop
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double half_width = rows.row(i).tail(widths).dot(solution.tail(widths));
    middle.push_back({readings[i].strain, readings[i].stress - half_width});
  }
  fit.elastic.residuals = residualsOf(fit.elastic.curve, middle);
  return fit;
}

BendingFit fitBending(const ReadingLoop& loop) {
  requireLoading(loop);
  std::vector<CurvePoint> deviations;
  const Line there = bendingLine(loop.loading, "loading", deviations);
  BendingFit fit{there.slope, std::nullopt, 0, {}};
  if (!loop.unloading.empty()) {
    const Line back = bendingLine(loop.unloading, "unloading", deviations);
    const double middle = 0.5 * (kLeastCurvature + kMostCurvature);
    fit.rigidity = 0.5 * (there.slope + back.slope);
    const double width = there.offset - back.offset + middle * (there.slope - back.slope);
    if (width < -TesterFile::kMostFall * std::abs(fit.rigidity) * middle) {
      base::refuse("has a larger moment while unloading than while loading, by ", -width,
                   " N at 100 1/m: loading is where the amount of curvature grows");
    }
    fit.hysteresis = std::max(width, 0.0);
  }
  if (fit.rigidity < 0.0) base::refuse("has the rigidity ", fit.rigidity, " N.m, must be >= 0");
  fit.readings = deviations.size();
  fit.residuals = residualsOf({{0.0, 1.0}, {{0.0, 0.0, 0.0, 0.0}}}, deviations);
  fit.residuals.scale = std::abs(there.offset + there.slope * kMostCurvature);
  return fit;
}

CompressionFit fitCompression(const ReadingLoop& loop, int pieces) {
  requireLoading(loop);
  std::vector<CurvePoint> samples;
  double least = kMaxFittedPressure, most = 0.0;
  for (const Reading& reading : loop.loading) {
    if (reading.y < 0.5 * kKesLowPressure) continue;
    samples.push_back({std::log(reading.y), -reading.x});
    least = std::min(least, reading.y);
    most = std::max(most, reading.y);
  }
  if (least > (1.0 + kReach) * kKesLowPressure || most < (1.0 - kReach) * kKesHighPressure) {
    base::refuse("has pressures from ", least, " to ", most, " Pa; readings must reach from ",
                 kKesLowPressure, " (or between that and its half) to ", kKesHighPressure,
                 " Pa, 0.5 and 50 gf/cm2");
  }
  CompressionFit fit;
  fit.points = thicknessPoints(fitThickness(samples, pieces));
  fit.readings = samples.size();
  const Compression curve = compressionFromPoints(fit.points);
  if (curve.thickness > kMaxFreeThicknessRatio * thicknessAt(curve, kKesLowPressure)) {
    base::refuse("would be ", curve.thickness, " m thick without pressure, at most ",
                 kMaxFreeThicknessRatio, " T0 is allowed: fewer pieces smooth more");
  }
  for (const auto& [logarithm, negative_thickness] : samples) {
    const double residual = thicknessAt(curve, std::exp(logarithm)) + negative_thickness;
    fit.residuals.rms += residual * residual / samples.size();
    fit.residuals.largest = std::max(fit.residuals.largest, std::abs(residual));
    fit.residuals.scale = std::max(fit.residuals.scale, -negative_thickness);
  }
  fit.residuals.rms = std::sqrt(fit.residuals.rms);

  const double t0 = thicknessAt(curve, kKesLowPressure), tm = thicknessAt(curve, kKesHighPressure);
  const auto energy = [&](double thickness) {
    return curve.thickness * curve.pressure.energy(1.0 - thickness / curve.thickness);
  };
  fit.kes = {t0, tm, energy(tm) - energy(t0)};
  if (loop.unloading.empty()) return fit;
  std::vector<CurvePoint> unloading = pointsOf(loop.unloading);
  std::sort(unloading.begin(), unloading.end(),
            [](const CurvePoint& a, const CurvePoint& b) { return a.strain < b.strain; });
  double returned = 0.0;
  constexpr int kParts = 2000;
  for (int i = 0; i < kParts; ++i) {
    returned +=
        unloadingPressure(unloading, tm + (t0 - tm) * (i + 0.5) / kParts) * (t0 - tm) / kParts;
  }
  fit.resilience = returned / fit.kes.work;
  return fit;
}

SurfaceFit fitSurface(const ReadingLoop& loop) {
  std::vector<double> values;
  for (const auto* branch : {&loop.loading, &loop.unloading}) {
    for (const Reading& reading : *branch) values.push_back(std::abs(reading.y));
  }
  const auto mean_of = [&](const auto& of) {
    double sum = 0.0;
    for (const double value : values) sum += of(value) / values.size();
    return sum;
  };
  const double mean = mean_of([](double value) { return value; });
  if (!(mean > 0.0)) base::refuse("has the mean coefficient ", mean, ", must be > 0");
  return {mean, mean_of([&](double value) { return std::abs(value - mean); })};
}

}  // namespace haptex::material
