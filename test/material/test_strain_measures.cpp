#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material::test_strain_measures {
namespace {

TEST(StrainMeasures, GreenStrainIsExact) {
  EXPECT_DOUBLE_EQ(greenStrain(0.1), 0.105);  // (1.21 - 1)/2
  EXPECT_DOUBLE_EQ(greenStrain(1.0), 1.5);
  EXPECT_DOUBLE_EQ(greenStrain(-0.5), -0.375);
  EXPECT_DOUBLE_EQ(greenStrain(-1.0), -0.5);
  EXPECT_EQ(greenStrain(0.0), 0.0);
}

TEST(StrainMeasures, EngineeringStrainInvertsGreenStrain) {
  for (const double strain : {-0.999, -0.5, -0.01, 0.005, 0.03, 0.6, 4.0}) {
    // Relative to the stretch, as the square root near collapse amplifies rounding by 1/l.
    EXPECT_NEAR(engineeringStrain(greenStrain(strain)), strain, 1e-15 / (1 + strain) + 1e-15)
        << strain;
  }
  EXPECT_DOUBLE_EQ(engineeringStrain(-0.5), -1.0);
}

TEST(StrainMeasures, KeepsRelativeAccuracyNearZero) {
  for (const double strain : {1e-17, -1e-12, 1e-9}) {
    EXPECT_DOUBLE_EQ(engineeringStrain(greenStrain(strain)), strain);
    EXPECT_NEAR(greenStrain(strain), strain, 1e-9 * std::abs(strain));
  }
}

TEST(StrainMeasures, ForceInvertsStress) {
  for (const double strain : {-0.9, -0.1, 0.0, 0.02, 0.6, 3.0}) {
    const double stress = secondPiolaStress(250.0, strain);
    EXPECT_NEAR(forcePerWidth(stress, greenStrain(strain)), 250.0, 250.0 * 1e-14) << strain;
  }
}

TEST(StrainMeasures, ConvertsTheEndOfAKesTensileTest) {
  // 500 gf/cm = 490.3325 N/m at 5 % extension: l = 1.05.
  const double stress = secondPiolaStress(490.3325, 0.05);
  EXPECT_NEAR(stress, 466.983333333333, 1e-12 * 467);
  EXPECT_DOUBLE_EQ(greenStrain(0.05), 0.05125);
  EXPECT_NEAR(forcePerWidth(stress, 0.05125), 490.3325, 1e-12 * 490);
}

TEST(StrainMeasures, BothMeasuresDoTheSameWork) {
  // Work per rest area of N = 300 e: 150 e^2, and the integral of N/l over Green strain, here by
  // the midpoint rule in 1e5 steps (error of order 1e-10).
  const double end = 0.4;
  const int steps = 100000;
  double work = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double e = end * (i + 0.5) / steps;
    const double width = greenStrain(end * (i + 1) / steps) - greenStrain(end * i / steps);
    work += secondPiolaStress(300.0 * e, e) * width;
  }
  EXPECT_NEAR(work, 150.0 * end * end, 1e-8);
}

TEST(StrainMeasures, ConvertsSamplesInOrder) {
  const auto points = curvePointsFromTester({{0.0, 0.0}, {0.1, 11.0}, {0.2, 24.0}});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].strain, 0.0);
  EXPECT_EQ(points[0].stress, 0.0);
  EXPECT_DOUBLE_EQ(points[1].strain, 0.105);
  EXPECT_DOUBLE_EQ(points[1].stress, 10.0);
  EXPECT_DOUBLE_EQ(points[2].strain, 0.22);
  EXPECT_DOUBLE_EQ(points[2].stress, 20.0);
}

TEST(StrainMeasures, RefusesSamplesByIndexAndValue) {
  const auto refusal = [](const CurvePoint& sample) -> std::string {
    return test::refusalOf([&] { curvePointsFromTester({{0.0, 0.0}, sample}); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal({-1.0, 0.0}), "points[1]: engineering strain -1 must be finite and > -1");
  EXPECT_EQ(refusal({nan, 0.0}), "points[1]: engineering strain nan must be finite and > -1");
  EXPECT_EQ(refusal({0.1, nan}), "points[1]: force per width nan must be finite");
}

}  // namespace
}  // namespace haptex::material::test_strain_measures
