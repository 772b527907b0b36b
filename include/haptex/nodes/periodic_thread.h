// A thread that works once per period of the steady clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "haptex/exoskeleton/clock.h"
#include "haptex/nodes/duration_histogram.h"

namespace haptex::nodes {

/// When to work next.
struct NextPeriod {
  exoskeleton::Time start{0};
  std::uint64_t missed = 0;  ///< periods whose start has passed already
};

/// @param start of the period that was worked for
/// @param now when that work was done
/// @returns the first start after `now` on the grid of periods
NextPeriod nextPeriod(exoskeleton::Time start, exoskeleton::Time period, exoskeleton::Time now);

/// Works at absolute times, so that lateness does not add up. A period whose start has passed
/// before the work for the one before is done is missed: it is counted and skipped, without a burst
/// of catching up. Asks for SCHED_FIFO with kLoopPriority and works without it too.
class PeriodicThread {
 public:
  using Time = exoskeleton::Time;

  /// On the thread; must not throw. @param now when the thread woke up
  using Work = std::function<void(Time now)>;

  /// Starts at once.
  /// @throws std::invalid_argument naming the period if it is not > 0
  PeriodicThread(Time period, Work work);
  /// As stop().
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Ends the thread after the work it is at, within about a period. Not to be called by the work.
  void stop();

  /// Why SCHED_FIFO was not granted, in plain words; empty if it was.
  const std::string& refusedScheduler() const { return refused_scheduler_; }
  /// Counts since the start, no units. By any thread.
  std::uint64_t periods() const { return periods_.load(std::memory_order_relaxed); }
  std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }
  /// How long after the start of its period the thread woke up. By any thread.
  const DurationHistogram& lateness() const { return lateness_; }

 private:
  void run();

  const Time period_;
  const Work work_;
  std::string refused_scheduler_;          // written by the constructor only
  DurationHistogram lateness_;             // written by the thread
  std::atomic<std::uint64_t> periods_{0};  // likewise
  std::atomic<std::uint64_t> missed_{0};   // likewise
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace haptex::nodes
