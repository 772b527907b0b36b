// Also built with the thread sanitizer, see scripts/test.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "exoskeleton_fixtures.h"
#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/exoskeleton/driver/request_box.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/ring.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/realtime/triple_buffer.h"
#include "haptex/serial/port_keeper.h"

namespace haptex::exoskeleton::test_exoskeleton_threads {
namespace {

using namespace std::chrono_literals;

/// Many copies of a number, which differ if a value is read while it is written.
struct Copies {
  std::array<std::uint64_t, 100> values{};

  static Copies of(std::uint64_t number) {
    Copies copies;
    copies.values.fill(number);
    return copies;
  }
  bool whole() const {
    for (const std::uint64_t value : values) {
      if (value != values[0]) return false;
    }
    return true;
  }
};

TEST(ExoskeletonThreads, ATripleBufferHandsOverWholeValuesNeverBackInTime) {
  constexpr std::uint64_t kLast = 20000;
  realtime::TripleBuffer<Copies> buffer;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) buffer.write(Copies::of(i));
  });
  std::uint64_t last = 0;
  bool good = true;
  while (last < kLast) {  // a last value that is not handed over would hang here
    if (!buffer.update()) continue;
    good = good && buffer.value().whole() && buffer.value().values[0] > last;
    last = buffer.value().values[0];
  }
  writer.join();
  EXPECT_TRUE(good);
}

TEST(ExoskeletonThreads, ARingHandsOverWholeValuesInOrder) {
  constexpr std::uint64_t kLast = 20000;
  realtime::Ring<Copies, 16> ring;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) ring.write(Copies::of(i));
  });
  Copies copies;
  std::uint64_t last = 0;
  std::uint64_t read = 0;
  bool good = true;
  while (ring.read(copies, 200ms)) {
    good = good && copies.whole() && copies.values[0] > last;
    last = copies.values[0];
    ++read;
  }
  writer.join();
  while (ring.read(copies, 0ms)) ++read;  // if it was slower than the patience
  EXPECT_TRUE(good);
  EXPECT_EQ(read + ring.lost(), kLast);
}

TEST(ExoskeletonThreads, EveryoneWhoAsksGetsTheAnswerToTheOwnRequest) {
  constexpr int kEach = 300;
  RequestBox box;
  std::atomic<bool> stop{false};
  std::thread loop([&] {
    DriverRequest request{};
    while (!stop) {
      if (box.take(request)) box.answer(std::to_string(static_cast<int>(request)));
    }
  });
  std::atomic<int> wrong{0};
  std::vector<std::thread> askers;
  for (const DriverRequest request :
       {DriverRequest::kEnable, DriverRequest::kPause, DriverRequest::kClearFault}) {
    askers.emplace_back([&, request] {
      for (int i = 0; i < kEach; ++i) {
        if (box.ask(request) != std::to_string(static_cast<int>(request))) ++wrong;
      }
    });
  }
  for (std::thread& asker : askers) asker.join();
  stop = true;
  loop.join();
  EXPECT_EQ(wrong, 0);
}

TEST(ExoskeletonThreads, AHistogramIsReadWhileItIsFilled) {
  constexpr std::uint64_t kLast = 50000;
  realtime::DurationHistogram histogram;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kLast; ++i) histogram.add(Time(i));
  });
  std::uint64_t total = 0;
  bool rises = true;
  while (total < kLast) {
    const std::uint64_t now = histogram.counts().total();
    rises = rises && now >= total;
    total = now;
  }
  writer.join();
  EXPECT_TRUE(rises);
  EXPECT_EQ(histogram.counts().largest, Time(kLast - 1));
}

TEST(ExoskeletonThreads, ThePortIsOpenedWhileTheLoopLooksAndOthersAsk) {
  const TemporaryDirectory directory;
  const std::string path = directory.path() + "/port";
  PortKeeper ports(path);
  std::atomic<bool> stop{false};
  std::atomic<int> texts{0};
  std::thread asker([&] {
    while (!stop) texts += static_cast<int>(ports.trouble().size() < 1000);
  });
  for (int round = 0; round < 2; ++round) {
    auto terminal = std::make_unique<serial::PseudoTerminal>(path);
    while (!ports.takeNew()) std::this_thread::yield();
    terminal.reset();
    std::uint8_t byte = 0;
    while (!ports.isClosed()) ports.read(&byte, 1);
    ports.discard();
    EXPECT_FALSE(ports.isThere());
  }
  stop = true;
  asker.join();
  EXPECT_GT(texts, 0);
}

TEST(ExoskeletonThreads, TheLoopTicksOnWhileEverybodyWantsSomething) {
  constexpr std::uint64_t kStates = 300;
  const StillDevice device;
  DriverLoop loop(device.port(), exoskeleton::shippedUrdf());
  const realtime::PeriodicThread thread(DriverLoop::kPeriod, [&](Time now) { loop.tick(now); });
  std::atomic<bool> stop{false};
  std::atomic<int> bad{0};
  std::vector<std::thread> others;
  // On a busy machine eight threads that never rest would leave the loop no time to answer.
  const auto rest = [] { std::this_thread::sleep_for(100us); };
  for (const Finger finger : {Finger::kIndex, Finger::kThumb, Finger::kThumb}) {
    others.emplace_back([&, finger] {
      ForceCommand command;
      command.force.z() = 1.0;
      for (; !stop; rest()) loop.command(finger, command, realtime::steadyNow());
    });
  }
  for (const DriverRequest request : {DriverRequest::kEnable, DriverRequest::kDisable,
                                      DriverRequest::kHome, DriverRequest::kClearFault}) {
    others.emplace_back([&, request] {
      for (; !stop; rest()) {
        bad += loop.ask(request).find("has not answered") != std::string::npos ? 1 : 0;
      }
    });
  }
  others.emplace_back([&] {
    std::uint64_t ticks = 0;
    for (; !stop; rest()) {
      const std::uint64_t now = loop.status().ticks;
      if (now < ticks) ++bad;
      ticks = now;
      if (!loop.portTrouble().empty() && loop.status().states > 0) ++bad;
      thread.lateness().counts();
    }
  });
  DriverSnapshot snapshot;
  std::uint64_t states = 0;
  while (states < kStates) {  // a loop that stands still would hang here
    if (!loop.takeMeasured(snapshot, 100ms)) continue;
    if (snapshot.states <= states) ++bad;
    states = snapshot.states;
  }
  stop = true;
  for (std::thread& other : others) other.join();
  EXPECT_EQ(bad, 0);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_exoskeleton_threads
