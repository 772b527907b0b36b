#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "haptex/tactile/kes_surface.h"

namespace haptex::tactile::test_kes_surface {
namespace {

constexpr double kMillimetre = 1e-3;

/// The high-pass of the tester for a wave of `length` (m), felt at 1 mm/s.
std::complex<double> highPass(double length) {
  const std::complex<double> s(0.0, 2.0 * M_PI * kMillimetre / length);
  const double natural = 2.0 * M_PI;
  return s * s / (s * s + 2.0 * 0.6 * natural * s + natural * natural);
}

/// One period of a profile along weft, the same on both rows.
template <typename F>
HeightField alongWeft(int samples, double length, F profile) {
  HeightField field{samples, 2, length / samples, 1e-4, {}};
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < samples; ++i) field.heights.push_back(profile(2.0 * M_PI * i / samples));
  }
  return field;
}

/// Weft becomes warp.
HeightField turned(const HeightField& field) {
  HeightField result{field.rows, field.columns, field.warp_spacing, field.weft_spacing, {}};
  for (int column = 0; column < field.columns; ++column) {
    for (int row = 0; row < field.rows; ++row) result.heights.push_back(field.at(column, row));
  }
  return result;
}

/// A stroke of which the reverse looks different.
double sawtooth(double phase) {
  return 1e-6 * (5.0 * std::sin(phase) + 3.0 * std::sin(2.0 * phase + 0.4));
}

TEST(KesSurface, FindsTheDeviationsOfASinusoidBehindTheHighPass) {
  // The mean of |cos| over n samples differs from 2/pi by up to pi^2/(3 n^2) of it.
  const int samples = 1000;
  const double tolerance = 1.01 * M_PI * M_PI / (3.0 * samples * samples);
  const double amplitude = 7e-6;
  for (const double length : {0.2e-3, 0.5e-3, 1e-3, 2e-3, 10e-3}) {
    const HeightField field =
        alongWeft(samples, length, [&](double phase) { return amplitude * std::sin(phase + 0.3); });
    // Half of the mean of both directions: along warp the field is flat.
    const double expected = 0.5 * std::abs(highPass(length)) * 2.0 * amplitude / M_PI;
    const double slope = expected * 2.0 * M_PI / length;
    for (const HeightField& either : {field, turned(field)}) {
      const KesSurface found = testSurface(either);
      EXPECT_NEAR(found.roughness, expected, tolerance * expected) << length;
      EXPECT_NEAR(found.slope_deviation, slope, tolerance * slope) << length;
    }
  }
}

TEST(KesSurface, FiltersEveryWaveWithItsPhaseThereAndBack) {
  const int samples = 240;
  const double length = 3e-3;
  double roughness = 0.0, slope = 0.0;
  for (const bool back : {false, true}) {
    for (int i = 0; i < samples; ++i) {
      std::complex<double> height = 0.0, derivative = 0.0;
      for (const auto& [wave, amplitude, phase] :
           {std::tuple{1.0, 5e-6, 0.0}, std::tuple{2.0, 3e-6, 0.4}}) {
        std::complex<double> response = highPass(length / wave);
        if (back) response = std::conj(response);
        const double k = 2.0 * M_PI * wave / length;
        const std::complex<double> value =
            amplitude * response *
            std::exp(std::complex<double>(0.0, 2.0 * M_PI * wave * i / samples + phase));
        height += value;
        derivative += std::complex<double>(0.0, k) * value;
      }
      // sin is the imaginary part. A quarter: two directions, and there and back.
      roughness += 0.25 * std::abs(height.imag()) / samples;
      slope += 0.25 * std::abs(derivative.imag()) / samples;
    }
  }
  const KesSurface found = testSurface(alongWeft(samples, length, sawtooth));
  EXPECT_NEAR(found.roughness, roughness, 1e-12 * roughness);
  EXPECT_NEAR(found.slope_deviation, slope, 1e-12 * slope);
}

TEST(KesSurface, IsTheSameForAReversedField) {
  HeightField field = alongWeft(64, 2e-3, sawtooth);
  const KesSurface found = testSurface(field);
  std::reverse(field.heights.begin(), field.heights.end());
  const KesSurface reversed = testSurface(field);
  EXPECT_NEAR(reversed.roughness, found.roughness, 1e-13 * found.roughness);
  EXPECT_NEAR(reversed.slope_deviation, found.slope_deviation, 1e-13 * found.slope_deviation);
}

TEST(KesSurface, DoesNotSeeTheMeanHeight) {
  HeightField field = alongWeft(63, 2e-3, sawtooth);  // odd
  const KesSurface found = testSurface(field);
  for (double& height : field.heights) height += 1e-3;
  const KesSurface lifted = testSurface(field);
  // Waves of a profile near 1 mm are known to some 1e-19 m.
  EXPECT_NEAR(lifted.roughness, found.roughness, 1e-17);
  EXPECT_NEAR(lifted.slope_deviation, found.slope_deviation, 1e-17 / field.weft_spacing);
}

TEST(KesSurface, IsZeroForAFlatField) {
  const KesSurface found = testSurface(alongWeft(64, 2e-3, [](double) { return 0.0; }));
  EXPECT_EQ(found.roughness, 0.0);
  EXPECT_EQ(found.slope_deviation, 0.0);
}

TEST(KesSurface, RefusesUnsoundFields) {
  HeightField field = alongWeft(64, 2e-3, sawtooth);
  field.heights[5] = std::nan("");
  EXPECT_THROW(testSurface(field), std::invalid_argument);
  field.heights.pop_back();
  EXPECT_THROW(testSurface(field), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::tactile::test_kes_surface
