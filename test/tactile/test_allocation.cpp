// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile::test_allocation {
namespace {

TEST(TactileAllocation, AStepAllocatesNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  Surface surface;
  surface.small_scale = {kSpaceOfPeriodic(whiteNoise(60, 58)), 0.2};
  surface.large_scale = AmplitudeMap(2, 2, {{1.0, 0.5}, {0.9, 1.1}, {1.2, 1.3}, {0.8, 1.0}});
  TouchedFabric touched;
  touched.stroke = {{0.02, 0.01}, 0.5};
  touched.forces.fill(0.02);
  DriveWaveform even(48000.0), odd(44100.0), uneven(777.7);
  double largest = 0.0;

  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    touched.placement.origin.x() += 5e-4;
    const ArrayAmplitudes amplitudes = arrayAmplitudes(surface, touched, {});
    for (DriveWaveform* const waveform : {&even, &odd, &uneven}) {
      largest = std::max(largest, std::abs(waveform->step(amplitudes).back()[0]));
    }
    touched.stroke.velocity.y() = i % 10 == 0 ? std::nan("") : 0.01;
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
  EXPECT_GT(largest, 0.0);
}

}  // namespace
}  // namespace haptex::tactile::test_allocation
