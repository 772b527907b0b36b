#include <gtest/gtest.h>

#include "haptex/oracles/experiments/direct_stroke.h"
#include "haptex/oracles/experiments/known_surfaces.h"

namespace haptex::oracles::test_direct_stroke {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using tactile::HeightField;

TEST(InterpolatedRelief, IsExactForTheWavesOfItsField) {
  for (const auto& [columns, rows] : {std::pair(12, 15), {13, 10}}) {
    HeightField field = flatField(columns, rows, 1e-4, 2e-4);
    addGrating(field, 3, -2, 5e-6, 0.7);
    addGrating(field, 0, 4, 2e-6, 0.1);
    for (double& height : field.heights) height += 1e-5;
    const InterpolatedRelief relief(field);
    for (const Vector2d& place : {Vector2d(0.0, 0.0), {3.21e-4, 7.77e-4}, {-0.0101, 0.0333}}) {
      const Vector2d turns = 2.0 * M_PI * place.cwiseQuotient(relief.period());
      const double exact = 1e-5 + 5e-6 * std::cos(3.0 * turns.x() - 2.0 * turns.y() + 0.7) +
                           2e-6 * std::cos(4.0 * turns.y() + 0.1);
      EXPECT_NEAR(relief(place), exact, 1e-12 * exact) << columns << ' ' << place.transpose();
    }
  }
}

TEST(InterpolatedRelief, OddSamplesLieOnTheSameRelief) {
  const InterpolatedRelief relief(whiteNoise(8, 6));
  const HeightField odd = relief.oddlySampled();
  EXPECT_EQ(odd.columns, 9);
  EXPECT_EQ(odd.rows, 7);
  const InterpolatedRelief again(odd);
  EXPECT_TRUE(again.period().isApprox(relief.period()));
  const Vector2d place(1.23e-4, 4.1e-4);
  EXPECT_NEAR(again(place), relief(place), 1e-12 * 2e-5);
  EXPECT_EQ(InterpolatedRelief(odd).oddlySampled().columns, 9);
}

TEST(ClosedStrokes, FeelAGratingThroughTheFilters) {
  HeightField field = flatField(15, 13);
  addGrating(field, 2, 3, 4e-6);
  for (const Vector2i& crossings : {Vector2i(1, 0), {0, -1}, {2, 1}, {-1, 3}}) {
    const Vector2d way = crossings.cast<double>().cwiseProduct(Vector2d(1.5e-3, 1.3e-3));
    const double frequency = std::abs(2 * crossings.x() + 3 * crossings.y()) * 0.05 / way.norm();
    const auto felt = alongClosedStrokes(field, crossings, 0.05);
    for (const auto channel : {tactile::k40, tactile::k320}) {
      EXPECT_NEAR(felt[channel], 4e-6 * tactile::gain(channel, frequency), 1e-12 * 4e-6);
    }
  }
}

TEST(ClosedStrokes, WavesOfTheSameFrequencyDoNotInterfere) {
  // (3, 1) and (1, 2) are both line 5 of a stroke with 1 and 2 crossings.
  HeightField field = flatField(15, 15);
  addGrating(field, 3, 1, 3e-6, 0.2);
  addGrating(field, 1, 2, 4e-6, 0.9);
  const double frequency = 5.0 * 0.05 / (1.5e-3 * std::sqrt(5.0));
  EXPECT_NEAR(alongClosedStrokes(field, {1, 2}, 0.05)[tactile::k40],
              5e-6 * tactile::gain(tactile::k40, frequency), 1e-12 * 5e-6);
}

TEST(ClosedStrokes, RefuseCrossingsWithACommonDivisor) {
  const HeightField field = flatField(4, 4);
  for (const Vector2i& crossings : {Vector2i(0, 0), {2, 4}, {3, 0}, {-6, 3}}) {
    EXPECT_THROW(alongClosedStrokes(field, crossings, 0.05), std::invalid_argument)
        << crossings.transpose();
  }
}

TEST(LongStrokes, FeelAWaveThroughTheFiltersButForTheWidthOfTheirLines) {
  constexpr double kLength = 0.7e-3;
  const Relief relief = [](const Vector2d& place) {
    return 4e-6 * std::cos(2.0 * M_PI / kLength * place.x());
  };
  for (const double degrees : {0.0, 33.0, 60.0}) {
    const Vector2d velocity = 0.06 * direction(degrees);
    const auto felt = alongLongStrokes(relief, {velocity, 0.1, 1e-4, 2, {0.01, 0.01}});
    for (const auto channel : {tactile::k40, tactile::k320}) {
      // Lines are 0.6 Hz apart and a few wide: second order in 1 Hz over some 40 Hz.
      const double exact = 4e-6 * tactile::gain(channel, velocity.x() / kLength);
      EXPECT_NEAR(felt[channel], exact, 2e-3 * exact) << degrees;
    }
  }
}

}  // namespace
}  // namespace haptex::oracles::test_direct_stroke
