#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::material::test_strain_stress_curve {
namespace {

using test::refusalOf;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Rising, level and falling stretches, unequal widths, on both sides of zero.
std::vector<CurvePoint> unevenPoints() {
  return {{-0.3, -4.0}, {-0.25, -4.5}, {-0.01, -0.2}, {0.0, 0.0},  {0.001, 0.4},
          {0.02, 0.5},  {0.05, 0.5},   {0.1, 7.0},    {0.13, 6.0}, {0.4, 90.0}};
}

StrainStressCurve unevenCurve() {
  return StrainStressCurve::fit(unevenPoints(), NegativeBranch::kLinear);
}

// stress = 100 e + 500 e^3 in two intervals that meet at 0.1, from -0.2 to 0.3.
StrainStressCurve cubicCurve() {
  const auto at = [](double e) {
    return std::array<double, 4>{100 * e + 500 * e * e * e, 100 + 1500 * e * e, 1500 * e, 500.0};
  };
  return StrainStressCurve::fromPolynomials({-0.2, 0.1, 0.3}, {at(-0.2), at(0.1)});
}

// Composite Simpson rule over [a, b]; exact for cubics when no knot lies inside of a step.
double integral(const StrainStressCurve& curve, double a, double b, int steps) {
  double sum = 0.0;
  const double h = (b - a) / steps;
  for (int i = 0; i < steps; ++i) {
    const double x = a + i * h;
    sum += curve.evaluate(x).stress + 4.0 * curve.evaluate(x + h / 2).stress +
           curve.evaluate(x + h).stress;
  }
  return sum * h / 6.0;
}

TEST(StrainStressCurve, PassesThroughEveryPoint) {
  const StrainStressCurve curve = unevenCurve();
  for (const CurvePoint& point : unevenPoints()) {
    // 90 is the largest stress; a value that ends an interval is rounded relative to its terms.
    EXPECT_NEAR(curve.evaluate(point.strain).stress, point.stress, 1e-13 * 90) << point.strain;
  }
}

TEST(StrainStressCurve, RisesFallsOrStaysLevelBetweenNeighboursAsTheyDo) {
  const StrainStressCurve curve = unevenCurve();
  const std::vector<CurvePoint> points = unevenPoints();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double rise = points[i].stress - points[i - 1].stress;
    double before = points[i - 1].stress;
    for (int k = 1; k <= 1000; ++k) {
      const double strain =
          points[i - 1].strain + (points[i].strain - points[i - 1].strain) * k / 1000.0;
      const double stress = curve.evaluate(strain).stress;
      const double step = stress - before;
      const double rounding = 1e-12;  // 90 N/m times a few units in the last place
      if (rise > 0) {
        ASSERT_GE(step, -rounding) << strain;
      }
      if (rise < 0) {
        ASSERT_LE(step, rounding) << strain;
      }
      if (rise == 0) {
        ASSERT_EQ(stress, points[i].stress) << strain;
      }
      before = stress;
    }
  }
}

TEST(StrainStressCurve, KeepsStressAndSlopeContinuousAtEveryKnot) {
  for (const StrainStressCurve& curve :
       {unevenCurve(), cubicCurve(), StrainStressCurve::linear(3.0)}) {
    std::vector<double> knots = {-0.2, 0.1, 0.3, curve.firstKnot(), curve.lastKnot()};
    for (const CurvePoint& point : unevenPoints()) knots.push_back(point.strain);
    for (const double knot : knots) {
      const CurveValue below = curve.evaluate(std::nextafter(knot, -1.0));
      const CurveValue above = curve.evaluate(knot);
      // Between neighbouring doubles only a jump could change more than rounding does.
      EXPECT_NEAR(below.stress, above.stress, 1e-12) << knot;
      EXPECT_NEAR(below.slope, above.slope, 1e-11 * (1 + std::abs(above.slope))) << knot;
    }
  }
}

TEST(StrainStressCurve, SlopeIsTheDerivativeOfStress) {
  const StrainStressCurve curve = unevenCurve();
  const double h = 1e-6;
  for (double strain = -0.5; strain < 0.6; strain += 0.00077) {
    const double difference =
        (curve.evaluate(strain + h).stress - curve.evaluate(strain - h).stress) / (2 * h);
    // Half the jump of the second derivative (up to 1e6 N/m here) times h, at a knot within h.
    EXPECT_NEAR(curve.evaluate(strain).slope, difference, 1.0) << strain;
  }
  const StrainStressCurve smooth = cubicCurve();
  for (double strain = -0.19; strain < 0.29; strain += 0.0007) {
    const double difference =
        (smooth.evaluate(strain + h).stress - smooth.evaluate(strain - h).stress) / (2 * h);
    EXPECT_NEAR(smooth.evaluate(strain).slope, difference, 1e-6) << strain;  // 500 h^2 + 1e-14 / h
  }
}

TEST(StrainStressCurve, EnergyIsTheIntegralOfStressFromZero) {
  const StrainStressCurve curve = unevenCurve();
  EXPECT_EQ(curve.energy(0.0), 0.0);
  std::vector<double> bounds = {0.0, 0.001, 0.02, 0.05, 0.1, 0.13, 0.4, 0.7};
  double sum = 0.0;
  for (std::size_t i = 1; i < bounds.size(); ++i) {
    sum += integral(curve, bounds[i - 1], bounds[i], 1);
    EXPECT_NEAR(curve.energy(bounds[i]), sum, 1e-13 * 100) << bounds[i];
  }
  bounds = {0.0, -0.01, -0.25, -0.3, -0.8};
  sum = 0.0;
  for (std::size_t i = 1; i < bounds.size(); ++i) {
    sum += integral(curve, bounds[i - 1], bounds[i], 1);
    EXPECT_NEAR(curve.energy(bounds[i]), sum, 1e-13 * 100) << bounds[i];
  }
}

TEST(StrainStressCurve, EnergyKeepsItsRelativeAccuracyNearZero) {
  const StrainStressCurve curve = cubicCurve();  // zero strain lies inside of an interval
  for (const double strain : {1e-3, -1e-3, 0.25, -0.15, 0.1, -0.2}) {
    const double exact = 50 * strain * strain + 125 * std::pow(strain, 4);
    EXPECT_NEAR(curve.energy(strain), exact, 1e-9 * exact) << strain;
  }
  const StrainStressCurve fitted =
      StrainStressCurve::fit({{0.1, 10.0}, {0.2, 20.0}}, NegativeBranch::kOdd);
  for (const double strain : {1e-7, -1e-7}) {
    // From the mirrored knot at -0.1 the energy 0.5 is cancelled down to 5e-13.
    EXPECT_NEAR(fitted.energy(strain), 50 * strain * strain, 1e-15) << strain;
  }
}

TEST(StrainStressCurve, ReproducesItsPolynomials) {
  const StrainStressCurve curve = cubicCurve();
  for (double strain = -0.2; strain <= 0.3; strain += 0.001) {
    EXPECT_NEAR(curve.evaluate(strain).stress, 100 * strain + 500 * std::pow(strain, 3), 1e-13);
    EXPECT_NEAR(curve.evaluate(strain).slope, 100 + 1500 * strain * strain, 1e-12);
  }
  EXPECT_EQ(curve.firstKnot(), -0.2);
  EXPECT_EQ(curve.lastKnot(), 0.3);
}

TEST(StrainStressCurve, ContinuesAsAStraightLineOutsideOfItsKnots) {
  const StrainStressCurve curve = cubicCurve();
  const double last_stress = 100 * 0.3 + 500 * 0.027;
  const double last_slope = 100 + 1500 * 0.09;
  const double first_stress = -100 * 0.2 - 500 * 0.008;
  const double first_slope = 100 + 1500 * 0.04;
  for (const double distance : {0.0, 1e-3, 1.0, 1e6}) {
    const double scale = 1e-14 * (1 + distance) * 300;
    EXPECT_NEAR(curve.evaluate(0.3 + distance).stress, last_stress + last_slope * distance, scale);
    EXPECT_NEAR(curve.evaluate(0.3 + distance).slope, last_slope, 1e-12);
    EXPECT_NEAR(curve.evaluate(-0.2 - distance).stress, first_stress - first_slope * distance,
                scale);
    EXPECT_NEAR(curve.evaluate(-0.2 - distance).slope, first_slope, 1e-12);
  }
}

TEST(StrainStressCurve, ContinuesIntoCompressionWithTheInitialSlope) {
  const auto curve = StrainStressCurve::fit({{0.1, 2.0}, {0.2, 9.0}}, NegativeBranch::kLinear);
  EXPECT_DOUBLE_EQ(curve.evaluate(0.0).slope, 20.0);
  EXPECT_DOUBLE_EQ(curve.evaluate(-0.4).stress, -8.0);
  EXPECT_DOUBLE_EQ(curve.evaluate(0.3).stress, 9.0 + 70.0 * 0.1);
}

TEST(StrainStressCurve, OddFitIsOdd) {
  const auto curve =
      StrainStressCurve::fit({{0.03, 1.0}, {0.1, 2.0}, {0.2, 9.0}}, NegativeBranch::kOdd);
  EXPECT_EQ(curve.firstKnot(), -0.2);
  for (double strain = 0.0; strain < 0.5; strain += 0.0031) {
    const CurveValue positive = curve.evaluate(strain);
    const CurveValue negative = curve.evaluate(-strain);
    EXPECT_NEAR(negative.stress, -positive.stress, 1e-13);
    EXPECT_NEAR(negative.slope, positive.slope, 1e-12);
    EXPECT_NEAR(curve.energy(-strain), curve.energy(strain), 1e-14);
  }
}

TEST(StrainStressCurve, KeepsMeasuredNegativeStrainsInAnOddFit) {
  const auto curve = StrainStressCurve::fit({{-0.1, -5.0}, {0.1, 2.0}}, NegativeBranch::kOdd);
  EXPECT_DOUBLE_EQ(curve.evaluate(-0.1).stress, -5.0);
  EXPECT_DOUBLE_EQ(curve.evaluate(0.1).stress, 2.0);
}

TEST(StrainStressCurve, AddsTheOriginWhereverItBelongs) {
  for (const std::vector<CurvePoint>& points :
       {std::vector<CurvePoint>{{0.1, 2.0}}, {{-0.1, -2.0}}, {{-0.1, -2.0}, {0.1, 2.0}}}) {
    const auto curve = StrainStressCurve::fit(points, NegativeBranch::kLinear);
    EXPECT_EQ(curve.evaluate(0.0).stress, 0.0);
    EXPECT_DOUBLE_EQ(curve.evaluate(0.05).stress, 1.0);
    EXPECT_DOUBLE_EQ(curve.evaluate(-0.05).stress, -1.0);
  }
}

TEST(StrainStressCurve, IsExactlyZeroAtZero) {
  EXPECT_EQ(unevenCurve().evaluate(0.0).stress, 0.0);
  EXPECT_EQ(StrainStressCurve::linear(7.0).evaluate(0.0).stress, 0.0);
  EXPECT_EQ(StrainStressCurve().evaluate(0.0).stress, 0.0);
}

TEST(StrainStressCurve, LinearHasItsModulusEverywhere) {
  const auto curve = StrainStressCurve::linear(100.0);
  for (const double strain : {-1e9, -0.5, -1e-12, 0.0, 0.3, 1.0, 17.0, 1e9}) {
    EXPECT_DOUBLE_EQ(curve.evaluate(strain).stress, 100.0 * strain);
    EXPECT_EQ(curve.evaluate(strain).slope, 100.0);
    EXPECT_NEAR(curve.energy(strain), 50.0 * strain * strain, 1e-13 * 50.0 * strain * strain);
  }
}

TEST(StrainStressCurve, TellsWhetherItIsZero) {
  EXPECT_TRUE(StrainStressCurve().isZero());
  EXPECT_TRUE(StrainStressCurve::linear(0.0).isZero());
  EXPECT_TRUE(StrainStressCurve::fit({{0.1, 0.0}}, NegativeBranch::kOdd).isZero());
  EXPECT_FALSE(StrainStressCurve::linear(1e-300).isZero());
  EXPECT_FALSE(unevenCurve().isZero());
  EXPECT_EQ(StrainStressCurve().evaluate(-3.0).stress, 0.0);
}

TEST(StrainStressCurve, MinimumSlopeIsTheLowestOfADenseScan) {
  // Falls only inside of the interval, and only on the lines outside, in turn.
  const auto dip = StrainStressCurve::fromPolynomials({0.0, 1.0}, {{0.0, 1.0, -3.0, 2.0}});
  EXPECT_DOUBLE_EQ(dip.minimumSlope(), -0.5);  // 1 - 6 x + 6 x^2 at x = 1/2
  const auto falling_end = StrainStressCurve::fromPolynomials({0.0, 1.0}, {{0.0, 1.0, -1.0, 0.0}});
  EXPECT_DOUBLE_EQ(falling_end.minimumSlope(), -1.0);
  EXPECT_EQ(StrainStressCurve::linear(5.0).minimumSlope(), 5.0);
  const StrainStressCurve curve = unevenCurve();
  double lowest = kInfinity;
  for (double strain = -0.5; strain < 0.5; strain += 1e-5) {
    lowest = std::min(lowest, curve.evaluate(strain).slope);
  }
  EXPECT_LE(curve.minimumSlope(), lowest + 1e-12 * std::abs(lowest));
  EXPECT_NEAR(curve.minimumSlope(), lowest, 1e-4 * std::abs(lowest));  // grid of the scan
}

TEST(StrainStressCurve, ReturnsNanForNanAndInfinity) {
  for (const StrainStressCurve& curve : {unevenCurve(), StrainStressCurve()}) {
    for (const double strain : {kNan, kInfinity, -kInfinity}) {
      EXPECT_TRUE(std::isnan(curve.evaluate(strain).stress)) << strain;
      EXPECT_FALSE(std::isfinite(curve.energy(strain))) << strain;
    }
  }
}

TEST(StrainStressCurve, SurvivesHugeStrains) {
  const StrainStressCurve curve = unevenCurve();
  for (const double strain : {1e15, 1e100, 1e300}) {
    EXPECT_DOUBLE_EQ(curve.evaluate(strain).stress, curve.evaluate(0.4).slope * strain);
    EXPECT_DOUBLE_EQ(curve.evaluate(-strain).stress, -curve.evaluate(-0.3).slope * strain);
  }
}

// Stress = sin(e) and slope = cos(e) at the knots, so that every interval has its own cubic; the
// second implementation walks along the knots. Both do the same arithmetic: equal to the last bit.
void expectLookupAgreesWithSearch(const std::vector<double>& knots) {
  std::vector<std::array<double, 4>> rows;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double h = knots[i + 1] - knots[i];
    const double secant = (std::sin(knots[i + 1]) - std::sin(knots[i])) / h;
    const double m0 = std::cos(knots[i]), m1 = std::cos(knots[i + 1]);
    rows.push_back(
        {std::sin(knots[i]), m0, (3 * secant - 2 * m0 - m1) / h, (m0 + m1 - 2 * secant) / (h * h)});
  }
  const auto curve = StrainStressCurve::fromPolynomials(knots, rows);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(knots.front(), knots.back());
  for (int n = 0; n < 100000; ++n) {
    double strain = inside(random);
    if (n % 4 == 0) strain = knots[random() % (knots.size() - 1)];
    if (n % 4 == 1) strain = std::nextafter(knots[1 + random() % (knots.size() - 1)], -1e9);
    std::size_t i = 0;
    while (i + 2 < knots.size() && strain >= knots[i + 1]) ++i;
    const auto& c = rows[i];
    const double x = strain - knots[i];
    ASSERT_EQ(curve.evaluate(strain).stress, c[0] + x * (c[1] + x * (c[2] + x * c[3]))) << strain;
    ASSERT_EQ(curve.evaluate(strain).slope, c[1] + x * (2 * c[2] + x * 3 * c[3])) << strain;
  }
}

TEST(StrainStressCurve, BinLookupAgreesWithASearchAlongTheKnots) {
  std::vector<double> uniform, uneven = {-1.0};
  for (int i = 0; i < 29; ++i) uniform.push_back(0.004078 * i);
  expectLookupAgreesWithSearch(uniform);
  for (int i = 0; i < 60; ++i) {
    // Widths from 1e-5 to 0.1: the narrowest would ask for many more than kMaxBins bins.
    uneven.push_back(uneven.back() + 0.1 * std::pow(10.0, -(i * 7 % 5)));
    if (uneven.back() > 0.0 && uneven[uneven.size() - 2] < 0.0) uneven.back() = 0.0;
  }
  expectLookupAgreesWithSearch(uneven);
  expectLookupAgreesWithSearch({-0.3, -0.1, 0.0, 1e-5, 0.1, 0.7});
  expectLookupAgreesWithSearch({0.0, 1.0 / 3.0});
}

TEST(StrainStressCurve, RefusesPointsByIndexAndValue) {
  const auto fit = [](std::vector<CurvePoint> points) {
    return refusalOf([&] { StrainStressCurve::fit(points, NegativeBranch::kLinear); });
  };
  EXPECT_EQ(fit({}), "points: has 0 points, must have at least one at a strain other than 0");
  EXPECT_EQ(fit({{0.0, 0.0}}),
            "points: has 1 points, must have at least one at a strain other than 0");
  EXPECT_EQ(fit({{0.0, 0.0}, {kNan, 1.0}}), "points[1]: strain nan is not finite");
  EXPECT_EQ(fit({{0.1, kInfinity}}), "points[0]: stress inf is not finite");
  EXPECT_EQ(fit({{0.1, 1.0}, {0.2, 2.0}, {0.15, 3.0}}),
            "points[2]: strain 0.15 must be greater than the one before, 0.2");
  EXPECT_EQ(fit({{0.1, 1.0}, {0.1, 2.0}}),
            "points[1]: strain 0.1 must be greater than the one before, 0.1");
  EXPECT_EQ(fit({{0.0, 0.5}, {0.1, 1.0}}), "points[0]: stress 0.5 at strain 0 must be 0");
  EXPECT_EQ(fit({{1e-300, 1e300}}),
            "the curve near strain 0 is too steep or too large for double arithmetic");
  EXPECT_EQ(fit({{-1e308, -1.0}, {1e308, 1.0}}),
            "the range of strains from -1e+308 to 1e+308 is too wide or too narrow for double "
            "arithmetic");
}

TEST(StrainStressCurve, RefusesModulusByValue) {
  const auto linear = [](double modulus) {
    return refusalOf([&] { StrainStressCurve::linear(modulus); });
  };
  EXPECT_EQ(linear(-1.0), "modulus: -1 must be finite and >= 0");
  EXPECT_EQ(linear(kNan), "modulus: nan must be finite and >= 0");
  EXPECT_EQ(linear(kInfinity), "modulus: inf must be finite and >= 0");
}

TEST(StrainStressCurve, RefusesPolynomialsByIndexAndValue) {
  using Rows = std::vector<std::array<double, 4>>;
  const auto polynomials = [](const std::vector<double>& knots, const Rows& rows) {
    return refusalOf([&] { StrainStressCurve::fromPolynomials(knots, rows); });
  };
  EXPECT_EQ(polynomials({0.0}, {}), "knots: has 1 numbers, must have at least 2");
  EXPECT_EQ(polynomials({0.0, 1.0}, {}), "coefficients: has 0 rows, must have one per interval: 1");
  EXPECT_EQ(polynomials({0.0, kNan}, {{0, 1, 0, 0}}), "knots[1]: nan is not finite");
  EXPECT_EQ(polynomials({0.0, 1.0, 1.0}, {{0, 1, 0, 0}, {1, 1, 0, 0}}),
            "knots[2]: 1 must be greater than the one before, 1");
  EXPECT_EQ(polynomials({0.0, 1.0}, {{0, 1, kInfinity, 0}}),
            "coefficients[0][2]: inf is not finite");
  EXPECT_EQ(polynomials({0.0, 1.0, 2.0}, {{0, 1, 0, 0}, {1.5, 1, 0, 0}}),
            "knots[1]: the stress jumps by 0.5 at strain 1, it must be continuous");
  EXPECT_EQ(polynomials({0.0, 1.0, 2.0}, {{0, 1, 0, 0}, {1, 3, 0, 0}}),
            "knots[1]: the slope jumps by 2 at strain 1, it must be continuous");
  EXPECT_EQ(polynomials({0.0, 1.0}, {{0.5, 1, 0, 0}}),
            "coefficients: the stress at strain 0 is 0.5, it must be 0");
  EXPECT_EQ(polynomials({1.0, 2.0}, {{0.5, 1, 0, 0}}),
            "coefficients: the stress at strain 0 is -0.5, it must be 0");
}

TEST(StrainStressCurve, AllowsJumpsWithinItsToleranceOnly) {
  const auto jump = [](double size) {
    return refusalOf([&] {
      StrainStressCurve::fromPolynomials({0.0, 1.0, 2.0}, {{0, 1, 0, 0}, {1 + size, 1, 0, 0}});
    });
  };
  // The largest stress at a knot is 2.
  EXPECT_EQ(jump(1.9 * StrainStressCurve::kJumpTolerance), test::kNotRefused);
  EXPECT_NE(jump(2.1 * StrainStressCurve::kJumpTolerance), test::kNotRefused);
}

}  // namespace
}  // namespace haptex::material::test_strain_stress_curve
