#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/material/compression.h"

namespace haptex::material::test_compression {
namespace {

double pressureAt(const Compression& compression, double thickness) {
  return compression.pressure.evaluate(1.0 - thickness / compression.thickness).stress;
}

// Work per area from one thickness to a smaller one: the curve's energy is by strain.
double workBetween(const Compression& compression, double from, double to) {
  const double t = compression.thickness;
  return t *
         (compression.pressure.energy(1.0 - to / t) - compression.pressure.energy(1.0 - from / t));
}

const std::vector<KesCompression> kSamples = {
    {0.65e-3, 0.45e-3, 0.17},  // a worsted: linearity 0.35
    {1.5e-3, 0.9e-3, 0.5},     // a knit: 0.34
    {0.5e-3, 0.4e-3, 0.15},    // stiff: 0.61
    {2.0e-3, 1.5e-3, 0.3},     // hairy: 0.24
};

TEST(CompressionFromKes, ReproducesThicknessesAndWork) {
  for (const KesCompression& kes : kSamples) {
    const Compression compression = compressionFromKes(kes);
    const double t0 = kes.low_pressure_thickness, tm = kes.high_pressure_thickness;
    EXPECT_NEAR(pressureAt(compression, t0), 49.03325, 1e-9);
    EXPECT_NEAR(pressureAt(compression, tm), 4903.325, 1e-8);
    // The work of the interpolant, not of the law that it interpolates.
    EXPECT_NEAR(workBetween(compression, t0, tm), kes.work, 1e-5 * kes.work) << kes.work;
    EXPECT_EQ(compression.pressure.evaluate(0.0).stress, 0.0);
  }
}

TEST(CompressionFromKes, FollowsVanWykAroundAnIncompressibleCore) {
  // The other way round: choose a core of 0.3 mm and constants, compute the three numbers by hand,
  // and expect the law back up to the last step of the fit, whose outer slope is that of a secant.
  const double core = 0.3e-3, t0 = 0.7e-3, tm = 0.42e-3;
  const double x0 = t0 - core, xm = tm - core;
  const double a = (4903.325 - 49.03325) / (std::pow(xm, -3) - std::pow(x0, -3));
  const double b = 4903.325 - a * std::pow(xm, -3);
  const double work = a / 2.0 * (std::pow(xm, -2) - std::pow(x0, -2)) + b * (t0 - tm);
  const Compression compression = compressionFromKes({t0, tm, work});
  for (double x = x0; a * std::pow(x, -3) + b < 1.9e6; x *= 0.99) {
    const double expected = a * std::pow(x, -3) + b;
    EXPECT_NEAR(pressureAt(compression, core + x), expected, 2e-5 * expected) << x;
  }
  // Below 0.5 gf/cm^2 the tangent at T0, whose slope is 3 a / x0^4.
  EXPECT_NEAR(compression.thickness, t0 + 49.03325 * std::pow(x0, 4) / (3.0 * a), 1e-12);
}

TEST(CompressionFromKes, RisesEverywhereAndKeepsAThickness) {
  for (const KesCompression& kes : kSamples) {
    const Compression compression = compressionFromKes(kes);
    EXPECT_GT(compression.pressure.minimumSlope(), 0.0);
    const double last = compression.pressure.lastKnot();
    EXPECT_LT(last, 1.0);
    EXPECT_GT(compression.pressure.evaluate(last).stress, 1.9e6);
  }
}

std::string refusalOf(const KesCompression& kes) {
  return test::refusalOf([&] { compressionFromKes(kes); });
}

TEST(CompressionFromKes, RefusesThicknessesThatDoNotFall) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf({0.0, 0.4e-3, 0.1}), "T0: 0 must be finite and > 0");
  EXPECT_EQ(refusalOf({nan, 0.4e-3, 0.1}), "T0: nan must be finite and > 0");
  EXPECT_EQ(refusalOf({6e-4, 0.0, 0.1}), "Tm: 0 must be > 0 and less than T0, 0.0006");
  EXPECT_EQ(refusalOf({6e-4, 6e-4, 0.1}), "Tm: 0.0006 must be > 0 and less than T0, 0.0006");
  EXPECT_EQ(refusalOf({6e-4, nan, 0.1}), "Tm: nan must be > 0 and less than T0, 0.0006");
}

TEST(CompressionFromKes, RefusesWorkThatNoCurveWithACoreDoes) {
  // T0 = 1 mm, Tm = 0.5 mm. Least: 49.03325 Pa over 0.5 mm. Most: the core vanishes, r = 1, and
  // the part is 4 / 14 of 4854.29175 Pa over 0.5 mm.
  const std::string range =
      " must be > 0.0245166 and <= 0.717987 J/m2 for these T0 and Tm: more leaves no thickness to "
      "an incompressible core";
  EXPECT_EQ(refusalOf({1e-3, 0.5e-3, 0.72}), "WC: 0.72" + range);
  EXPECT_EQ(refusalOf({1e-3, 0.5e-3, 0.024}), "WC: 0.024" + range);
  EXPECT_EQ(refusalOf({1e-3, 0.5e-3, std::numeric_limits<double>::infinity()}), "WC: inf" + range);
  EXPECT_EQ(refusalOf({1e-3, 0.5e-3, 0.717}), test::kNotRefused);
}

TEST(CompressionFromKes, RefusesAFabricThatIsMostlyAir) {
  // T0 = 1 mm, Tm = 0.5 mm and r = 0.1, a part of 0.13 / 2.66 of the work: x0 = 0.55 mm,
  // xm = 0.05 mm, a = 6.0724e-10, so 2.463 mm more than T0.
  EXPECT_EQ(
      refusalOf({1e-3, 0.5e-3, 0.143136}),
      "WC: 0.143136 is too small: without pressure the fabric would be 0.00346299 m thick, at "
      "most 2 T0 is allowed");
}

TEST(CompressionFromPoints, PassesThroughEveryPointAndRises) {
  const std::vector<ThicknessPoint> points = {
      {0.0, 0.8e-3}, {50.0, 0.7e-3}, {500.0, 0.6e-3}, {2000.0, 0.5e-3}, {5000.0, 0.45e-3}};
  const Compression compression = compressionFromPoints(points);
  EXPECT_EQ(compression.thickness, 0.8e-3);
  for (const auto& [pressure, thickness] : points) {
    EXPECT_NEAR(pressureAt(compression, thickness), pressure, 1e-12 * 5000.0);
  }
  EXPECT_GT(compression.pressure.minimumSlope(), 0.0);
}

TEST(CompressionFromPoints, GoesOnWithThePowerThatContinuesTheLastSlope) {
  // Last slope 3000 Pa over 0.05 mm: exponent 6e7 * 0.45e-3 / 5000 = 5.4.
  const Compression compression =
      compressionFromPoints({{0.0, 0.8e-3}, {2000.0, 0.5e-3}, {5000.0, 0.45e-3}});
  for (double thickness = 0.44e-3; thickness > 0.16e-3; thickness -= 0.01e-3) {
    const double expected = 5000.0 * std::pow(0.45e-3 / thickness, 5.4);
    EXPECT_NEAR(pressureAt(compression, thickness), expected, 1e-4 * expected) << thickness;
  }
  EXPECT_LT(compression.pressure.lastKnot(), 1.0);  // some thickness is left at 2 MPa
}

std::string pointsRefusalOf(const std::vector<ThicknessPoint>& points) {
  return test::refusalOf([&] { compressionFromPoints(points); });
}

TEST(CompressionFromPoints, RefusesPointsThatAreNoCompression) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pointsRefusalOf({}), "points: has 0 points, must have at least 2");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}}), "points: has 1 points, must have at least 2");
  EXPECT_EQ(pointsRefusalOf({{1, 1e-3}, {2, 9e-4}}),
            "points[0]: pressure 1 must be 0: the thickness without pressure");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {-1, 9e-4}}),
            "points[1]: pressure -1 must be from 0 to 2e+06 Pa");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {3e6, 9e-4}}),
            "points[1]: pressure 3e+06 must be from 0 to 2e+06 Pa");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {nan, 9e-4}}),
            "points[1]: pressure nan must be from 0 to 2e+06 Pa");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {5, 9e-4}, {5, 8e-4}}),
            "points[2]: pressure 5 must be greater than the one before, 5");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {5, 1e-3}}),
            "points[1]: thickness 0.001 must be less than the one before, 0.001");
  EXPECT_EQ(pointsRefusalOf({{0, 1e-3}, {5, 0.0}}),
            "points[1]: thickness 0 must be finite and > 0");
  EXPECT_EQ(pointsRefusalOf({{0, nan}, {5, 1e-3}}),
            "points[0]: thickness nan must be finite and > 0");
}

}  // namespace
}  // namespace haptex::material::test_compression
