// Driver and emulator with their threads and a real pseudo-terminal between them, as in the nodes
// but without ROS, for what only a clock can tell: how late the loops wake up, and how long a
// commanded force takes to reach the sensor.
#pragma once

#include <unistd.h>

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/exoskeleton/emulator/emulator.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/realtime/steady_clock.h"
#include "tab_lines.h"

namespace haptex::bench {

/// Keeps this many cores busy.
class BusyCores {
 public:
  explicit BusyCores(int count) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([this] {
        while (!stopping_.load(std::memory_order_relaxed)) benchmark::ClobberMemory();
      });
    }
  }
  ~BusyCores() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;
};

class RealExoskeleton {
 public:
  using Time = base::Time;

  /// Homes and enables the device. @throws std::runtime_error if that does not succeed
  explicit RealExoskeleton(const std::string& urdf)
      : link_(std::filesystem::temp_directory_path() /
              ("haptex_bench_" + std::to_string(getpid()))),
        emulator_(urdf, link_, [](const exoskeleton::EmulatorSample&) {}),
        driver_(link_, urdf),
        emulator_thread_(exoskeleton::Emulator::kPeriod,
                         [this](Time now) { emulator_.advanceTo(now); }),
        driver_thread_(exoskeleton::DriverLoop::kPeriod, [this](Time now) { driver_.tick(now); }) {
    makeReady();
  }

  /// Prints wake-up lateness and latency while forces of `low` and `high` (N) take turns.
  void measure(const std::string& load, double low, double high, int steps) {
    const auto lateness_before = driver_thread_.lateness().counts();
    const std::uint64_t missed_before = driver_thread_.missed();
    realtime::DurationHistogram latency;
    int unseen = 0, faults = 0;
    run(high, low, kSettling, nullptr);
    for (int i = 0; i < steps; ++i) {
      const bool up = i % 2 == 0;
      const bool seen = run(up ? low : high, up ? high : low, kStepPeriod, &latency);
      if (enabled()) {
        if (!seen) ++unseen;
        continue;
      }
      ++faults;  // this machine took one of the two threads its time for too long
      makeReady();
      run(low, up ? high : low, kSettling, nullptr);
    }
    print("exoskeleton/wake_up_" + load, driver_thread_.lateness().counts().since(lateness_before));
    printLine("exoskeleton/missed_periods_" + load,
              static_cast<double>(driver_thread_.missed() - missed_before), "periods");
    print("exoskeleton/command_to_sensor_" + load, latency.counts());
    printLine("exoskeleton/commands_unseen_" + load, unseen, "commands");
    printLine("exoskeleton/faults_" + load, faults, "faults");
  }

  /// 1 if the loop runs under SCHED_FIFO.
  void printScheduler() const {
    printLine("exoskeleton/sched_fifo_granted", driver_thread_.refusedScheduler().empty() ? 1 : 0,
              "yes");
  }

 private:
  static constexpr Time kStepPeriod = std::chrono::milliseconds(60);
  static constexpr Time kSettling = std::chrono::milliseconds(1500);  // soft start and more
  /// The sensor has seen a step when it shows this share of it, far above its noise.
  static constexpr double kSeen = 0.1;

  /// Commands `to` once per state for a while and notes how long after its first command the sensor
  /// left `from`. @returns false if it did not
  bool run(double from, double to, Time duration, realtime::DurationHistogram* latency) {
    exoskeleton::ForceCommand command;
    command.force = {0.0, 0.0, to};
    const Time begin = realtime::steadyNow();
    bool seen = false;
    exoskeleton::DriverSnapshot snapshot;
    for (Time now = begin; now < begin + duration; now = realtime::steadyNow()) {
      driver_.command(base::Finger::kIndex, command, now);
      if (!driver_.takeMeasured(snapshot, std::chrono::milliseconds(20))) continue;
      if (seen || latency == nullptr || snapshot.state_time < begin) continue;
      const double force = snapshot.fingers[base::Finger::kIndex].force.z();
      if ((force - from) / (to - from) < kSeen) continue;
      seen = true;
      latency->add(snapshot.state_time - begin);
    }
    return seen;
  }

  static void print(const std::string& name, const realtime::DurationHistogram::Counts& counts) {
    const auto line = [&](const char* which, Time time) {
      printLine(name + "_" + which, 1e6 * base::seconds(time), "us");
    };
    line("p50", counts.quantile(0.5));
    line("p99", counts.quantile(0.99));
    line("p99.9", counts.quantile(0.999));
    line("max", counts.quantile(1.0));
  }

  bool enabled() const {
    return driver_.status().operating_state.mode == exoskeleton::Mode::kEnabled;
  }

  /// As a person would: asks for what is missing until forces are on.
  void makeReady() {
    for (int i = 0; i < 3000; ++i) {
      const exoskeleton::OperatingState state = driver_.status().operating_state;
      if (state.mode == exoskeleton::Mode::kEnabled) return;
      if (state.mode == exoskeleton::Mode::kFault) {
        driver_.ask(exoskeleton::DriverRequest::kClearFault);
      } else if (!state.is_homed && !state.is_busy) {
        driver_.ask(exoskeleton::DriverRequest::kHome);
      } else if (state.is_homed) {
        driver_.ask(exoskeleton::DriverRequest::kEnable);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("the exoskeleton could not be enabled within 30 s");
  }

  std::string link_;
  exoskeleton::Emulator emulator_;
  exoskeleton::DriverLoop driver_;
  realtime::PeriodicThread emulator_thread_;
  realtime::PeriodicThread driver_thread_;
};

}  // namespace haptex::bench
