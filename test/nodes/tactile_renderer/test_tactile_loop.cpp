#include <gtest/gtest.h>

#include "haptex/nodes/tactile_renderer/tactile_loop.h"
#include "tactile_fixtures.h"

namespace haptex::nodes::test_tactile_loop {
namespace {

using namespace std::chrono_literals;
using base::Finger;

const ros::Time kStamp(1234, 5678);

TEST(TactileLoop, AGratingStrokedAtTheFrequencyOfAChannelVibratesWithItsHeight) {
  const tactile::Surface surface = grating();
  TactileLoop loop(tactile::ArrayLimits{});
  loop.receive(Finger::kIndex, slidingContact(), 1ms);
  loop.step({&surface, &surface}, 25ms, kStamp);
  const haptex::Tactile& index = loop.messages()[Finger::kIndex];
  for (const double amplitude : index.amplitudes_40) {
    EXPECT_NEAR(amplitude, 1e6 * kWaveHeight * kShareOfOne, 1e-9);
  }
  // What the channel of 320 Hz feels of 40 Hz: r - 1/r = 7.875 in G320 = 1/(1 + (r - 1/r)^2).
  EXPECT_NEAR(index.amplitudes_320[0], index.amplitudes_40[0] / (1.0 + 7.875 * 7.875), 1e-9);
  EXPECT_EQ(index.header.stamp, kStamp);
  EXPECT_TRUE(loop.touching(Finger::kIndex));
  EXPECT_FALSE(loop.touching(Finger::kThumb));
  EXPECT_EQ(loop.messages()[Finger::kThumb].amplitudes_40[0], 0.0);
}

TEST(TactileLoop, IsZeroInTheFirstStepWithoutAMessage) {
  const tactile::Surface surface = grating();
  TactileLoop loop(tactile::ArrayLimits{});
  loop.receive(Finger::kThumb, slidingContact(), 1ms);
  loop.step({&surface, &surface}, 25ms, kStamp);
  EXPECT_GT(loop.messages()[Finger::kThumb].amplitudes_40[0], 0.0);
  loop.step({&surface, &surface}, 50ms, kStamp);
  haptex::Tactile silent = tactileMessage(Finger::kThumb);
  silent.header.stamp = kStamp;
  silent.step_time = 0.025;
  EXPECT_EQ(loop.messages()[Finger::kThumb], silent);
}

TEST(TactileLoop, FollowsTheFabricUnderTheFinger) {
  TactileLoop loop(tactile::ArrayLimits{});
  EXPECT_EQ(loop.fabric(Finger::kIndex), 0u);
  haptex::Contact other = slidingContact();
  other.fabric = 1;
  loop.receive(Finger::kIndex, slidingContact(), 1ms);
  loop.receive(Finger::kIndex, other, 2ms);
  EXPECT_EQ(loop.fabric(Finger::kIndex), 1u);
  EXPECT_EQ(loop.fabric(Finger::kThumb), 0u);
  loop.receive(Finger::kIndex, noContact(), 3ms);
  EXPECT_EQ(loop.fabric(Finger::kIndex), 1u) << "what the step has touched is stroked to its end";
}

TEST(TactileLoop, ComputesNothingWithoutContactOrSurface) {
  const tactile::Surface surface = grating();
  TactileLoop loop(tactile::ArrayLimits{});
  loop.step({&surface, &surface}, 25ms, kStamp);
  loop.receive(Finger::kIndex, noContact(), 30ms);
  loop.step({&surface, &surface}, 50ms, kStamp);
  loop.receive(Finger::kIndex, slidingContact(), 60ms);
  loop.step({}, 75ms, kStamp);
  EXPECT_EQ(loop.messages()[Finger::kIndex].amplitudes_40[0], 0.0);
  EXPECT_GT(loop.messages()[Finger::kIndex].normal_force, 0.0);
  EXPECT_EQ(loop.computed(), 0u);
  EXPECT_EQ(loop.steps(), 3u);
  loop.receive(Finger::kIndex, slidingContact(), 80ms);
  loop.step({&surface, &surface}, 100ms, kStamp);
  EXPECT_EQ(loop.computed(), 1u);
}

TEST(TactileLoop, TellsTheTimeSinceTheStepBefore) {
  TactileLoop loop(tactile::ArrayLimits{});
  loop.step({}, 10s, kStamp);
  EXPECT_EQ(loop.messages()[Finger::kIndex].step_time, 0.025) << "the first has none before it";
  loop.step({}, 10s + 31ms, kStamp);
  EXPECT_DOUBLE_EQ(loop.messages()[Finger::kIndex].step_time, 0.031);
}

TEST(TactileLoop, KeepsToTheLimitsOfTheArray) {
  const tactile::Surface surface = grating();
  tactile::ArrayLimits limits;
  limits.lowest_frequency = 50.0;
  TactileLoop loop(limits);
  loop.receive(Finger::kIndex, slidingContact(), 1ms);
  loop.step({&surface, &surface}, 25ms, kStamp);
  EXPECT_EQ(loop.messages()[Finger::kIndex].amplitudes_40[0], 0.0);
  EXPECT_GT(loop.messages()[Finger::kIndex].amplitudes_320[0], 0.0);
  limits.largest_displacement = -1.0;
  EXPECT_THROW(TactileLoop{limits}, std::invalid_argument);
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_loop
