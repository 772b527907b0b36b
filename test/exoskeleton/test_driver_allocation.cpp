// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <thread>

#include "../malloc_counter.h"
#include "exoskeleton_fixtures.h"
#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::exoskeleton::test_driver_allocation {
namespace {

using namespace std::chrono_literals;

TEST(DriverAllocation, TheLoopDoesNotAllocateWhileItRendersAForce) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const TemporaryDirectory directory;
  const std::string port = directory.path() + "/exoskeleton";
  const LivingDevice device(port);
  DriverLoop loop(port, exoskeleton::shippedUrdf());
  const realtime::PeriodicThread thread(DriverLoop::kPeriod, [&](Time now) { loop.tick(now); });
  ForceCommand command;
  command.force = {0.0, 0.0, 1.0};
  const auto render = [&](int milliseconds) {
    DriverSnapshot snapshot;
    for (int i = 0; i < milliseconds; ++i) {
      loop.setGravity({0.0, 6.0, -7.0}, realtime::steadyNow());
      for (const Finger finger : kFingers) loop.command(finger, command, realtime::steadyNow());
      while (loop.takeMeasured(snapshot, 0ms)) {
      }
      std::this_thread::sleep_for(1ms);
    }
    return loop.status().fingers[Finger::kThumb].no_force == NoForceReason::kNone;
  };
  // Where the machine stands still for 10 ms, the device has to be made ready again.
  const Time end = realtime::steadyNow() + 30s;
  while (!render(10) && realtime::steadyNow() < end) {
    for (const DriverRequest request :
         {DriverRequest::kClearFault, DriverRequest::kEnable, DriverRequest::kHome}) {
      loop.ask(request);
    }
  }
  const long before = allocations;
  const std::uint64_t ticks = loop.status().ticks;
  EXPECT_TRUE(render(300));
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
  EXPECT_GT(loop.status().ticks, ticks + 100);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_driver_allocation
