#include <gtest/gtest.h>

#include <cmath>

#include "haptex/oracles/experiments/standard_stroke.h"

namespace haptex::oracles::test_standard_stroke {
namespace {

TEST(RankCorrelation, IsThatOfTheRanks) {
  EXPECT_DOUBLE_EQ(rankCorrelation({1.0, 2.0, 3.0, 40.0}, {-1.0, 0.0, 0.1, 0.2}), 1.0);
  EXPECT_DOUBLE_EQ(rankCorrelation({1.0, 2.0, 3.0}, {3.0, 2.0, 1.0}), -1.0);
  // 1 - 6 sum d^2/(n (n^2 - 1)) with two neighbours of five exchanged.
  EXPECT_DOUBLE_EQ(rankCorrelation({1, 2, 3, 4, 5}, {1, 3, 2, 4, 5}), 1.0 - 6.0 * 2.0 / 120.0);
  // Ranks 1, 2.5, 2.5, 4: product-moment correlation with 1, 2, 3, 4.
  EXPECT_DOUBLE_EQ(rankCorrelation({1, 2, 3, 4}, {1, 5, 5, 9}), 4.5 / std::sqrt(5.0 * 4.5));
}

TEST(RankCorrelation, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(rankCorrelation({1.0, 2.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(rankCorrelation({1.0}, {1.0}), std::invalid_argument);
}

TEST(StandardStrokes, AreTheMeanOfFourDirections) {
  // A wave along weft, felt by the strokes along weft and, at 1/sqrt(2) of the frequency, along
  // both diagonals.
  constexpr double kAmplitude = 6e-6, kLength = 0.3e-3;
  tactile::Surface surface;
  surface.small_scale.waves = {{2.0 * M_PI / kLength}, {0.0}, {0.5 * kAmplitude * kAmplitude}};
  const double force = kStandardForce / tactile::kContactors;
  const double share = force / (force + tactile::kHalfForce);
  const double fast = kStandardSpeed / kLength, slow = fast * std::sqrt(0.5);
  const auto felt = [&](tactile::Channel channel, double frequency) {
    return kAmplitude * share * tactile::gain(channel, frequency);
  };
  const RenderedStroke stroke = renderStrokes(surface);
  for (const auto channel : {tactile::k40, tactile::k320}) {
    const double exact = 0.25 * (felt(channel, fast) + 2.0 * felt(channel, slow));
    EXPECT_NEAR(stroke.amplitudes[channel], exact, 1e-12 * kAmplitude);
  }
  const auto both = [&](double f) {
    return std::hypot(felt(tactile::k40, f), felt(tactile::k320, f));
  };
  EXPECT_NEAR(stroke.intensity, 0.25 * (both(fast) + 2.0 * both(slow)), 1e-12 * kAmplitude);
  const auto perceived = [&](double f) {
    return felt(tactile::k40, f) + 0.5 * felt(tactile::k320, f);
  };
  EXPECT_NEAR(stroke.perceived_intensity, 0.25 * (perceived(fast) + 2.0 * perceived(slow)),
              1e-12 * kAmplitude);
}

}  // namespace
}  // namespace haptex::oracles::test_standard_stroke
