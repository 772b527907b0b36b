// Also built with the thread sanitizer, see scripts/test.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "haptex/realtime/steady_clock.h"
#include "haptex/simulation/force_loop.h"

namespace haptex::simulation::test_force_threads {
namespace {

using base::Finger;
using base::Time;

/// Within one process fingertips come on the driver's thread and single poses on that of the
/// sockets; when one begins and the other ends both may write.
TEST(ForceThreads, PosesAreWholeWhoeverBringsThem) {
  constexpr int kEach = 20000;
  constexpr int kWriters = 2;
  constexpr base::PerFinger<double> kRadii{{0.0075, 0.009}};
  ForceLoop loop(kRadii);
  std::atomic<int> writing{kWriters};
  std::vector<std::thread> writers;
  for (int writer = 0; writer < kWriters; ++writer) {
    writers.emplace_back([&, writer] {
      for (int i = 0; i < kEach; ++i) {
        const int number = kWriters * i + writer;
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation().setConstant(number);
        loop.receivePose(Finger::kIndex, pose, realtime::steadyNow(), Time(number));
        loop.receiveTwist(Finger::kIndex, {}, realtime::steadyNow());
        loop.receiveHeartbeat(realtime::steadyNow());
      }
      --writing;
    });
  }
  bool whole = true;
  do {
    loop.tick(realtime::steadyNow());
    const ForceLoop::Rendered& rendered = loop.rendered(Finger::kIndex);
    const auto number = static_cast<double>(rendered.measured.count());
    whole = whole && (rendered.contact.position.array() == number).all();
  } while (writing > 0);
  for (std::thread& writer : writers) writer.join();
  EXPECT_TRUE(whole);
  loop.tick(realtime::steadyNow());  // on a busy machine the first one after the writers
  EXPECT_GT(loop.rendered(Finger::kIndex).measured, Time{0});
}

}  // namespace
}  // namespace haptex::simulation::test_force_threads
