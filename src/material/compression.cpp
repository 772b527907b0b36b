#include "haptex/material/compression.h"

#include <cmath>
#include <iomanip>

#include "haptex/base/require.h"

namespace haptex::material {
namespace {

// Pressure from one fitted point to the next: small enough for 2e-5 of the pressure.
constexpr double kPressureRatio = 1.04;
// The last step, which ends at kMaxFittedPressure, starts below this: it is not tiny.
constexpr double kMaxStepStart = 0.99 * kMaxFittedPressure;

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  base::refuse(std::setprecision(6), parts...);
}

void requirePoints(const std::vector<ThicknessPoint>& points) {
  if (points.size() < 2) refuse("points: has ", points.size(), " points, must have at least 2");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [pressure, thickness] = points[i];
    if (!std::isfinite(pressure) || pressure < 0.0 || pressure > kMaxFittedPressure) {
      refuse("points[", i, "]: pressure ", pressure, " must be from 0 to ", kMaxFittedPressure,
             " Pa");
    }
    if (!std::isfinite(thickness) || thickness <= 0.0) {
      refuse("points[", i, "]: thickness ", thickness, " must be finite and > 0");
    }
    if (i == 0 && pressure != 0.0) {
      refuse("points[0]: pressure ", pressure, " must be 0: the thickness without pressure");
    }
    if (i > 0 && pressure <= points[i - 1].pressure) {
      refuse("points[", i, "]: pressure ", pressure, " must be greater than the one before, ",
             points[i - 1].pressure);
    }
    if (i > 0 && thickness >= points[i - 1].thickness) {
      refuse("points[", i, "]: thickness ", thickness, " must be less than the one before, ",
             points[i - 1].thickness);
    }
  }
}

// The first point is at pressure 0.
Compression fitted(const std::vector<ThicknessPoint>& points) {
  const double free_thickness = points.front().thickness;
  std::vector<CurvePoint> curve;
  for (const auto& [pressure, thickness] : points) {
    curve.push_back({(free_thickness - thickness) / free_thickness, pressure});
  }
  return {free_thickness, StrainStressCurve::fit(curve, NegativeBranch::kLinear)};
}

void requireThicknesses(const KesCompression& kes) {
  const double t0 = kes.low_pressure_thickness, tm = kes.high_pressure_thickness;
  if (!std::isfinite(t0) || t0 <= 0.0) refuse("T0: ", t0, " must be finite and > 0");
  if (!std::isfinite(tm) || tm <= 0.0 || tm >= t0) {
    refuse("Tm: ", tm, " must be > 0 and less than T0, ", t0);
  }
}

// With x = thickness - core, D = T0 - Tm and r = x(Tm) / D, van Wyk's law through the pressures at
// T0 and Tm does, above the constant pressure at T0, the part
//   w(r) = r (1 + 3 r) / (2 (1 + 3 r + 3 r^2)) < 1/2
// of the work (pressure at Tm - pressure at T0) D. It rises with r.
double workPart(double r) { return r * (1.0 + 3.0 * r) / (2.0 * (1.0 + 3.0 * r + 3.0 * r * r)); }

// The positive root of w(r) = w, written without cancellation at small w.
double ratioForWorkPart(double w) {
  return 4.0 * w / (1.0 - 6.0 * w + std::sqrt(1.0 + 12.0 * w * (1.0 - w)));
}

}  // namespace

Compression compressionFromPoints(const std::vector<ThicknessPoint>& points) {
  requirePoints(points);
  const ThicknessPoint& last = points.back();
  const ThicknessPoint& before = points[points.size() - 2];
  const double slope = (last.pressure - before.pressure) / (before.thickness - last.thickness);
  const double exponent = slope * last.thickness / last.pressure;
  std::vector<ThicknessPoint> continued = points;
  const auto add = [&](double pressure) {
    const double ratio = pressure / last.pressure;
    continued.push_back({pressure, last.thickness * std::pow(ratio, -1.0 / exponent)});
  };
  for (double p = last.pressure * kPressureRatio; p < kMaxStepStart; p *= kPressureRatio) {
    add(p);
  }
  if (last.pressure < kMaxStepStart) add(kMaxFittedPressure);
  return fitted(continued);
}

Compression compressionFromKes(const KesCompression& kes) {
  requireThicknesses(kes);
  const double t0 = kes.low_pressure_thickness, tm = kes.high_pressure_thickness;
  const double range = t0 - tm;
  const double rise = kKesHighPressure - kKesLowPressure;
  const double least_work = kKesLowPressure * range;
  const double largest_work = least_work + workPart(tm / range) * rise * range;
  if (!std::isfinite(kes.work) || kes.work <= least_work || kes.work > largest_work) {
    refuse("WC: ", kes.work, " must be > ", least_work, " and <= ", largest_work,
           " J/m2 for these T0 and Tm: more leaves no thickness to an incompressible core");
  }
  const double ratio = ratioForWorkPart((kes.work - least_work) / (rise * range));
  const double xm = ratio * range, x0 = xm + range;
  const double core = tm - xm;
  const double a = rise / (std::pow(xm, -3.0) - std::pow(x0, -3.0));
  const double free_thickness = t0 + kKesLowPressure * std::pow(x0, 4.0) / (3.0 * a);
  if (free_thickness > kMaxFreeThicknessRatio * t0) {
    refuse("WC: ", kes.work, " is too small: without pressure the fabric would be ", free_thickness,
           " m thick, at most ", kMaxFreeThicknessRatio, " T0 is allowed");
  }
  std::vector<ThicknessPoint> points = {{0.0, free_thickness}};
  const auto add = [&](double pressure) {
    const double x = std::cbrt(a / (pressure - kKesLowPressure + a / (x0 * x0 * x0)));
    points.push_back({pressure, core + x});
  };
  // A whole number of steps from T0 to Tm, so that both are points.
  const int steps = static_cast<int>(
      std::ceil(std::log(kKesHighPressure / kKesLowPressure) / std::log(kPressureRatio)));
  const double step = std::pow(kKesHighPressure / kKesLowPressure, 1.0 / steps);
  for (int i = 0; i <= steps; ++i) add(kKesLowPressure * std::pow(step, i));
  for (double p = kKesHighPressure * step; p < kMaxStepStart; p *= step) add(p);
  add(kMaxFittedPressure);
  return fitted(points);
}

}  // namespace haptex::material
