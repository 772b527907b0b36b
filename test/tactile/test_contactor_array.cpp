#include <gtest/gtest.h>

#include <limits>

#include "fixtures.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::tactile::test_contactor_array {
namespace {

/// A wave felt at 100 Hz by the stroke of touch(), in both channels.
Surface wavy(double amplitude = 5e-6) {
  Surface surface;
  surface.small_scale = singleWave({2.0 * M_PI / 0.2e-3, 0.0}, amplitude, 0.1);
  return surface;
}

TouchedFabric touch(double force = 0.02) {
  TouchedFabric touched;
  touched.stroke = {{0.02, 0.0}, 0.5};
  touched.forces.fill(force);
  return touched;
}

/// A large scale that differs from cell to cell.
AmplitudeMap uneven() {
  std::vector<PerChannel<double>> values;
  for (int i = 0; i < 5 * 4; ++i) values.push_back({1.0 + 0.1 * (i % 7), 1.0 - 0.04 * (i % 9)});
  return {5, 4, values};
}

TEST(ContactorArray, HasSixByFourPlacesTwoMillimetresApartAroundItsMiddle) {
  EXPECT_TRUE(contactorPlace(0).isApprox(Eigen::Vector2d(-5e-3, -3e-3)));
  EXPECT_TRUE(contactorPlace(5).isApprox(Eigen::Vector2d(5e-3, -3e-3)));
  EXPECT_TRUE(contactorPlace(6).isApprox(Eigen::Vector2d(-5e-3, -1e-3)));
  EXPECT_TRUE(contactorPlace(23).isApprox(Eigen::Vector2d(5e-3, 3e-3)));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < kContactors; ++i) sum += contactorPlace(i);
  EXPECT_LT(sum.norm(), 1e-17);
}

TEST(ContactorArray, AmplitudesAreTheStrokesTimesPlaceTimesForce) {
  Surface surface = wavy();
  surface.large_scale = uneven();
  TouchedFabric touched = touch();
  touched.placement.origin = {0.0123, -0.0034};
  touched.placement.axes << 0.6, -0.8, 0.8, 0.6;
  for (int i = 0; i < kContactors; ++i) touched.forces[i] = 0.003 * i;
  const PerChannel<double> stroke = strokeAmplitudes(surface.small_scale, touched.stroke);
  const ArrayAmplitudes amplitudes = arrayAmplitudes(surface, touched, {});
  for (int i = 0; i < kContactors; ++i) {
    const Eigen::Vector2d p = contactorPlace(i);
    const auto local = surface.large_scale.at(
        {0.0123 + 0.6 * p.x() - 0.8 * p.y(), -0.0034 + 0.8 * p.x() + 0.6 * p.y()});
    const double share = 0.003 * i / (0.003 * i + 0.01);
    for (const Channel channel : {k40, k320}) {
      // Places differ by rounding, which the map's slope of up to 800 1/m passes on.
      EXPECT_NEAR(amplitudes[i][channel], stroke[channel] * local[channel] * share,
                  1e-12 * stroke[channel]);
    }
  }
  EXPECT_GT(amplitudes[23][k320], 0.0);
}

TEST(ContactorArray, LiftedContactorsAreSilent) {
  TouchedFabric touched = touch();
  touched.forces[3] = 0.0;
  touched.forces[7] = -0.1;
  const ArrayAmplitudes amplitudes = arrayAmplitudes(wavy(), touched, {});
  for (int i = 0; i < kContactors; ++i) {
    for (const double amplitude : amplitudes[i]) {
      if (i == 3 || i == 7) {
        EXPECT_EQ(amplitude, 0.0);
      } else {
        EXPECT_GT(amplitude, 0.0);
      }
    }
  }
}

TEST(ContactorArray, ChannelsOutsideOfItsBandAreSilent) {
  for (const auto& [limits, silent, heard] :
       {std::tuple(ArrayLimits{20.0, 300.0, 1e-4}, k320, k40), {{50.0, 400.0, 1e-4}, k40, k320}}) {
    for (const auto& amplitudes : arrayAmplitudes(wavy(), touch(), limits)) {
      EXPECT_EQ(amplitudes[silent], 0.0);
      EXPECT_GT(amplitudes[heard], 0.0);
    }
  }
}

TEST(ContactorArray, TheLargestDisplacementKeepsTheRatioOfTheChannels) {
  const ArrayLimits limits{20.0, 400.0, 3e-6};
  const ArrayAmplitudes free = arrayAmplitudes(wavy(5e-5), touch(), {20.0, 400.0, 1.0});
  const ArrayAmplitudes held = arrayAmplitudes(wavy(5e-5), touch(), limits);
  for (int i = 0; i < kContactors; ++i) {
    EXPECT_NEAR(held[i][k40] + held[i][k320], 3e-6, 1e-20);
    EXPECT_NEAR(held[i][k320] / held[i][k40], free[i][k320] / free[i][k40], 1e-13);
  }
  // Below the limit nothing changes.
  EXPECT_EQ(arrayAmplitudes(wavy(1e-7), touch(), limits),
            arrayAmplitudes(wavy(1e-7), touch(), {20.0, 400.0, 1.0}));
}

TEST(ContactorArray, SmallChangesOfPlaceAndForceAreSmallChangesOfAmplitudes) {
  Surface surface = wavy(2e-5);
  surface.large_scale = uneven();
  const ArrayLimits limits{20.0, 400.0, 1e-5};  // reached by some contactors and not by others
  const PerChannel<double> stroke = strokeAmplitudes(surface.small_scale, touch().stroke);
  const double larger = std::max(stroke[k40], stroke[k320]);
  TouchedFabric touched = touch();
  ArrayAmplitudes before = arrayAmplitudes(surface, touched, limits);
  int moved = 0;
  for (int step = 1; step <= 4000; ++step) {
    // Across all cells, and the force up from nothing. The map's slope is below 700 1/m along each
    // axis, the share of force changes by at most 1/kHalfForce, and holding the sum of two at most
    // doubles either's change.
    touched.placement.origin = Eigen::Vector2d(3e-6, 2e-6) * step;
    for (double& force : touched.forces) force = 1e-5 * step;
    const ArrayAmplitudes after = arrayAmplitudes(surface, touched, limits);
    if (step > 1) {
      for (int i = 0; i < kContactors; ++i) {
        for (const Channel channel : {k40, k320}) {
          const double change = std::abs(after[i][channel] - before[i][channel]);
          ASSERT_LE(change, 2.0 * larger * (700.0 * 5e-6 + 1.6 * 1e-5 / kHalfForce));
          if (change > 0.0) ++moved;
        }
      }
    }
    before = after;
  }
  EXPECT_GT(moved, 0);
}

TEST(ContactorArray, WhatIsNotFiniteIsSilent) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    std::array<TouchedFabric, 5> all;
    all.fill(touch());
    all[0].stroke.velocity.y() = bad;
    all[1].stroke.normal_force = bad;
    all[2].placement.origin.x() = bad;
    all[3].placement.axes(1, 0) = bad;
    all[4].forces[11] = bad;
    for (const TouchedFabric& touched : all) {
      EXPECT_EQ(arrayAmplitudes(wavy(), touched, {}), ArrayAmplitudes{});
    }
  }
}

TEST(ArrayLimits, RefusalsNameLimitValueAndWhatIsAllowed) {
  const auto refusal_of = [](const ArrayLimits& limits) {
    return test::refusalOf([&] { requireSound(limits); });
  };
  EXPECT_EQ(refusal_of({}), test::kNotRefused);
  EXPECT_EQ(refusal_of({0.0, 400.0, 1e-4}),
            "the lowest frequency of the array is 0: allowed are finite numbers > 0 Hz");
  EXPECT_EQ(refusal_of({20.0, 20.0, 1e-4}),
            "the highest frequency of the array is 20: allowed are finite numbers above the "
            "lowest, Hz");
  EXPECT_EQ(refusal_of({20.0, 400.0, std::nan("")}),
            "the largest displacement of the array is nan: allowed are finite numbers > 0 m");
}

}  // namespace
}  // namespace haptex::tactile::test_contactor_array
