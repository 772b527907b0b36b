// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "haptex/nodes/tactile_renderer/tactile_loop.h"
#include "tactile_fixtures.h"

namespace haptex::nodes::test_tactile_allocation {
namespace {

using base::Finger;

TEST(TactileAllocation, StepsDoNotAllocateWhileAFingertipComesSlidesAndGoes) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const tactile::Surface surface = grating();
  TactileLoop loop(tactile::ArrayLimits{});
  const haptex::Contact none = noContact(), sliding = slidingContact();
  const long before = allocations;
  double largest = 0.0;
  for (int i = 0; i < 100; ++i) {
    const base::Time time = i * std::chrono::milliseconds(25);
    const bool slides = i > 20 && i < 80;
    for (const Finger finger : base::kFingers) {
      for (int j = 0; j < 25; ++j) loop.receive(finger, slides ? sliding : none, time);
    }
    loop.step({&surface, &surface}, time, ros::Time(1, 0));
    largest = std::max(largest, loop.messages()[Finger::kThumb].amplitudes_40[0]);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(largest, 1.0);
  EXPECT_GT(before, 0) << "the count does not work";
}

}  // namespace
}  // namespace haptex::nodes::test_tactile_allocation
