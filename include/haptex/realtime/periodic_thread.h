// A thread that works once per period, of the steady clock or of whoever calls it.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "haptex/base/clock.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/scheduling.h"
#include "haptex/realtime/semaphore.h"

namespace haptex::realtime {

/// When to work next.
struct NextPeriod {
  base::Time start{0};
  std::uint64_t missed = 0;  ///< periods whose start has passed already
};

/// @param start of the period that was worked for
/// @param now when that work was done
/// @returns the first start after `now` on the grid of periods
NextPeriod nextPeriod(base::Time start, base::Time period, base::Time now);

struct PeriodicThreadOptions {
  /// On the thread, between two works: waits for a call, until then at the latest.
  /// @returns whether there was one
  using Wait = std::function<bool(base::Time until)>;

  Wait wait;  ///< for calls of another kind than those of PeriodicThread::call()
  int priority = kLoopPriority;
  bool on_force_path = false;  ///< see keepOnForceProcessor()
};

/// Works at absolute times, so that lateness does not add up. A period whose start has passed
/// before the work for the one before is done is missed: it is counted and skipped, without a burst
/// of catching up. Asks for SCHED_FIFO and works without it too.
///
/// Where something else is the clock, a device that sends a state every millisecond, it calls, and
/// the thread works at once, but never twice within half a period. One and a half periods after the
/// last call the thread goes on by itself, on a grid of periods, until it is called again.
class PeriodicThread {
 public:
  using Time = base::Time;

  /// On the thread; must not throw. @param now when the thread woke up
  using Work = std::function<void(Time now)>;

  /// Starts at once.
  /// @throws std::invalid_argument naming the period if it is not > 0
  PeriodicThread(Time period, Work work, const PeriodicThreadOptions& options = {});
  /// As stop().
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// Ends the thread after the work it is at, within about a period. Not to be called by the work.
  void stop();

  /// By any thread: work now.
  void call();

  /// Why SCHED_FIFO was not granted, in plain words; empty if it was.
  const std::string& refusedScheduler() const { return refused_scheduler_; }
  /// Counts since the start, no units. By any thread.
  std::uint64_t periods() const { return periods_.load(std::memory_order_relaxed); }
  std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }
  /// How long after the start of its period the thread woke up; where it was called, by how much
  /// the time since the last work differed from a period. By any thread.
  const DurationHistogram& lateness() const { return lateness_; }

 private:
  void run();
  bool awaitCall(Time until);

  const Time period_;
  const Work work_;
  const PeriodicThreadOptions::Wait wait_;
  Semaphore called_;
  std::atomic<bool> is_called_{false};
  std::string refused_scheduler_;          // written by the constructor only
  DurationHistogram lateness_;             // written by the thread
  std::atomic<std::uint64_t> periods_{0};  // likewise
  std::atomic<std::uint64_t> missed_{0};   // likewise
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace haptex::realtime
