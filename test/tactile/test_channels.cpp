#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptex/tactile/channels.h"

namespace haptex::tactile::test_channels {
namespace {

TEST(Channels, GainIsOneAtTheChannelsFrequencyAndZeroAtRest) {
  for (const Channel channel : {k40, k320}) {
    EXPECT_EQ(gain(channel, kChannelFrequencies[channel]), 1.0);
    EXPECT_EQ(gain(channel, 0.0), 0.0);
    EXPECT_EQ(gain(channel, std::numeric_limits<double>::infinity()), 0.0);
    EXPECT_EQ(gain(channel, 1e200), 0.0);
  }
}

TEST(Channels, GainIsTheDocumentedOne) {
  // One octave away r - 1/r is 3/2: 1 + 9/4 = 13/4.
  for (const double octave : {0.5, 2.0}) {
    EXPECT_NEAR(gain(k40, 40.0 * octave), 1.0 / std::sqrt(3.25), 1e-15);
    EXPECT_NEAR(gain(k320, 320.0 * octave), 1.0 / 3.25, 1e-15);
  }
}

TEST(Channels, SkirtsFallBySixAndTwelveDecibelsPerOctave) {
  for (const double far : {1e-4, 1e4}) {
    const double farther = far < 1.0 ? 0.5 * far : 2.0 * far;
    // To terms of (1e-4)^2.
    EXPECT_NEAR(gain(k40, 40.0 * farther) / gain(k40, 40.0 * far), 0.5, 1e-7);
    EXPECT_NEAR(gain(k320, 320.0 * farther) / gain(k320, 320.0 * far), 0.25, 1e-7);
  }
}

TEST(Channels, EachFeelsItsOwnFrequencyBest) {
  EXPECT_LT(gain(k320, 40.0), 0.02);
  EXPECT_LT(gain(k40, 320.0), 0.13);
}

}  // namespace
}  // namespace haptex::tactile::test_channels
