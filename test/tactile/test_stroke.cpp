#include <gtest/gtest.h>

#include <limits>

#include "fixtures.h"
#include "haptex/tactile/stroke.h"

namespace haptex::tactile::test_stroke {
namespace {

constexpr double kRounding = 1e-13;  // relative: some tens of operations

void expectEqual(const PerChannel<double>& a, const PerChannel<double>& b, double tolerance) {
  for (const Channel channel : {k40, k320}) EXPECT_NEAR(a[channel], b[channel], tolerance);
}

SmallScale noise(double friction_per_slope = 0.0) {
  return {kSpaceOfPeriodic(whiteNoise(32, 30)), friction_per_slope};
}

TEST(Stroke, AGratingFollowsTheFiltersAtAllSpeedsAndAngles) {
  constexpr double kAmplitude = 4e-6, kLength = 0.5e-3;
  const Eigen::Vector2d across = direction(20.0);
  const SmallScale surface = singleWave(2.0 * M_PI / kLength * across, kAmplitude);
  for (int mm = 1; mm <= 300; mm += 13) {
    for (int degrees = 0; degrees <= 180; degrees += 5) {
      const Stroke stroke{1e-3 * mm * direction(degrees), 0.5};
      const double frequency = std::abs(across.dot(stroke.velocity)) / kLength;
      const PerChannel<double> felt = strokeAmplitudes(surface, stroke);
      for (const Channel channel : {k40, k320}) {
        EXPECT_NEAR(felt[channel], kAmplitude * gain(channel, frequency), kRounding * kAmplitude)
            << mm << " mm/s, " << degrees << " degrees";
      }
      const auto lines = strokeSpectrum(surface, stroke);
      ASSERT_EQ(lines.size(), 1u);
      EXPECT_NEAR(lines[0].frequency, frequency, kRounding * 600.0);  // Hz, of the fastest
      EXPECT_NEAR(lines[0].power, 0.5 * kAmplitude * kAmplitude, kRounding * 1e-11);
    }
  }
}

TEST(Stroke, ATurnedGratingIsATurnedStroke) {
  // The same length of wave in three directions that fit one field: 5^2 = 3^2 + 4^2.
  const Eigen::Vector2d base = 0.02 * direction(33.0);
  PerChannel<double> first{};
  for (const Eigen::Vector2i& numbers : {Eigen::Vector2i(5, 0), {3, 4}, {4, 3}, {-4, 3}, {0, 5}}) {
    HeightField field = flatField(24, 24);
    addGrating(field, numbers.x(), numbers.y(), 3e-6);
    Eigen::Matrix2d turn;
    turn << numbers.x(), -numbers.y(), numbers.y(), numbers.x();
    const SmallScale surface{kSpaceOfPeriodic(field), 0.1};
    const PerChannel<double> felt = strokeAmplitudes(surface, {turn * base / 5.0, 0.5});
    if (numbers.y() == 0) first = felt;
    expectEqual(felt, first, 1e-11 * first[k40]);  // beside it the rounding of other waves
  }
  EXPECT_GT(first[k40], 1e-6);
}

TEST(Stroke, TwoGratingsAddInPower) {
  HeightField first = flatField(20, 20), second = first, both = first;
  addGrating(first, 3, 1, 3e-6);
  addGrating(second, 1, 2, 2e-6, 1.1);
  addGrating(both, 3, 1, 3e-6);
  addGrating(both, 1, 2, 2e-6, 1.1);
  const Stroke stroke{0.03 * direction(70.0), 0.5};
  const auto felt = [&](const HeightField& field) {
    return strokeAmplitudes({kSpaceOfPeriodic(field), 0.2}, stroke);
  };
  for (const Channel channel : {k40, k320}) {
    const double sum = std::hypot(felt(first)[channel], felt(second)[channel]);
    EXPECT_NEAR(felt(both)[channel], sum, 1e-12 * sum);
  }
}

TEST(Stroke, WithoutMovementNothingIsFelt) {
  for (const Eigen::Vector2d& velocity : {Eigen::Vector2d(0.0, 0.0), {1e-10, 0.0}}) {
    EXPECT_EQ(strokeAmplitudes(noise(0.2), {velocity, 0.5}), (PerChannel<double>{}));
    EXPECT_TRUE(strokeSpectrum(noise(), {velocity, 0.5}).empty());
  }
}

TEST(Stroke, FadesInFromRest) {
  // At low speed a wave of 0.2 mm, the shortest of the field, is felt at 5 Hz per mm/s, far below
  // both channels: there the amplitudes grow as the speed and as its square.
  const auto felt = [&](double speed) {
    return strokeAmplitudes(noise(), {speed * direction(10.0), 0.5});
  };
  EXPECT_NEAR(felt(2e-6)[k40] / felt(1e-6)[k40], 2.0, 1e-6);
  EXPECT_NEAR(felt(2e-6)[k320] / felt(1e-6)[k320], 4.0, 1e-6);
}

TEST(Stroke, IsSymmetricUnderReversal) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const Stroke there{0.025 * direction(degrees), 0.4};
    const Stroke back{-there.velocity, 0.4};
    EXPECT_EQ(strokeAmplitudes(noise(0.3), there), strokeAmplitudes(noise(0.3), back));
  }
}

TEST(Stroke, FrictionAddsTheDisplacementOfTheSkinInPower) {
  constexpr double kAmplitude = 5e-6, kLength = 0.4e-3, kFrictionPerSlope = 0.25;
  const SmallScale surface = singleWave({2.0 * M_PI / kLength, 0.0}, kAmplitude, kFrictionPerSlope);
  for (const double degrees : {0.0, 30.0, 75.0}) {
    for (const double force : {0.1, 0.5, 2.0}) {
      const Stroke stroke{0.03 * direction(degrees), force};
      const double cosine = std::cos(degrees * M_PI / 180.0);
      const double frequency = 0.03 * cosine / kLength;
      const double slope = kAmplitude * 2.0 * M_PI / kLength * cosine;
      const double skin = kFrictionPerSlope * slope * force /
                          (kSkinStiffness * std::hypot(1.0, frequency / kSkinCorner));
      const double exact = std::hypot(kAmplitude, skin);
      EXPECT_GT(exact, 1.0001 * kAmplitude);
      const PerChannel<double> felt = strokeAmplitudes(surface, stroke);
      for (const Channel channel : {k40, k320}) {
        EXPECT_NEAR(felt[channel], gain(channel, frequency) * exact, kRounding * exact);
      }
    }
  }
}

TEST(Stroke, SpectrumIsSortedAndGivesTheAmplitudes) {
  const Stroke stroke{0.04 * direction(40.0), 0.8};
  const SmallScale surface = noise(0.3);
  const auto lines = strokeSpectrum(surface, stroke);
  ASSERT_EQ(lines.size(), surface.waves.size());
  PerChannel<double> power{};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_GE(lines[i].frequency, i == 0 ? 0.0 : lines[i - 1].frequency);
    for (const Channel channel : {k40, k320}) {
      power[channel] += 2.0 * std::pow(gain(channel, lines[i].frequency), 2) * lines[i].power;
    }
  }
  expectEqual(strokeAmplitudes(surface, stroke), {std::sqrt(power[k40]), std::sqrt(power[k320])},
              1e-12 * std::sqrt(power[k320]));
}

TEST(Stroke, ASmallChangeOfVelocityIsASmallChangeOfAmplitudes) {
  // |dG/df| is below 1.2/f_c for both filters, |dG/dv| so below 1.2 k/(2 pi f_c); over all waves
  // the change is at most that of the sharpest with all power. k <= sqrt(2) pi/0.1 mm.
  const SmallScale surface = noise();
  const double amplitude = std::sqrt(2.0 * surface.waves.totalPower());
  const double bound =
      amplitude * 1.2 * (std::sqrt(2.0) * M_PI / 1e-4) / (2.0 * M_PI * kChannelFrequencies[k40]);
  constexpr double kChange = 1e-7;  // m/s
  for (int degrees = 0; degrees < 360; degrees += 9) {
    const Eigen::Vector2d velocity(0.011, -0.007);
    const auto before = strokeAmplitudes(surface, {velocity, 0.5});
    const auto after = strokeAmplitudes(surface, {velocity + kChange * direction(degrees), 0.5});
    expectEqual(after, before, bound * kChange);
  }
}

TEST(Stroke, WhatIsNotFiniteIsNotFelt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector2d sound(0.02, 0.0);
  for (const Stroke& stroke : {Stroke{{nan, 0.0}, 0.5},
                               {{0.0, infinity}, 0.5},
                               {sound, nan},
                               {sound, -infinity},
                               {{1e200, 0.0}, 0.5},
                               {{1e80, 0.0}, 0.5},
                               {sound, 1e300}}) {
    EXPECT_EQ(strokeAmplitudes(noise(0.2), stroke), (PerChannel<double>{}));
  }
}

}  // namespace
}  // namespace haptex::tactile::test_stroke
