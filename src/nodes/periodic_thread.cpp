#include "haptex/nodes/periodic_thread.h"

#include <pthread.h>
#include <sys/prctl.h>

#include <cerrno>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "haptex/nodes/scheduling.h"
#include "haptex/nodes/steady_clock.h"

namespace haptex::nodes {
namespace {

using exoskeleton::Time;

void sleepUntil(Time time) {
  const timespec end = toTimespec(time);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr) == EINTR) {
  }
}

}  // namespace

NextPeriod nextPeriod(Time start, Time period, Time now) {
  const std::int64_t passed = now < start ? 0 : (now - start) / period;
  return {start + (passed + 1) * period, static_cast<std::uint64_t>(passed)};
}

PeriodicThread::PeriodicThread(Time period, Work work) : period_(period), work_(std::move(work)) {
  if (period <= Time{0}) {
    throw std::invalid_argument("period = " + std::to_string(period.count()) +
                                " ns: allowed are periods > 0");
  }
  thread_ = std::thread([this] { run(); });
  refused_scheduler_ = askForFifo(thread_.native_handle(), kLoopPriority);
}

PeriodicThread::~PeriodicThread() { stop(); }

void PeriodicThread::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void PeriodicThread::run() {
  // Without SCHED_FIFO the kernel may wake a thread 50 us late to save energy. 1 ns: as exact as
  // it can.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  NextPeriod next{steadyNow() + period_, 0};
  while (!stopping_) {
    sleepUntil(next.start);
    const Time now = steadyNow();
    lateness_.add(now - next.start);
    work_(now);
    periods_.fetch_add(1, std::memory_order_relaxed);
    next = nextPeriod(next.start, period_, steadyNow());
    missed_.fetch_add(next.missed, std::memory_order_relaxed);
  }
}

}  // namespace haptex::nodes
