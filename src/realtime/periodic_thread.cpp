#include "haptex/realtime/periodic_thread.h"

#include <pthread.h>
#include <sys/prctl.h>

#include <cstddef>
#include <stdexcept>
#include <utility>

#include "haptex/realtime/steady_clock.h"

namespace haptex::realtime {

using base::Time;

namespace {

/// So that the first calls of the work find their pages.
void touchStack() {
  constexpr std::size_t kBytes = 64 << 10;
  constexpr std::size_t kPage = 4 << 10;
  char stack[kBytes];
  volatile char* const pages = stack;
  for (std::size_t i = 0; i < kBytes; i += kPage) pages[i] = 0;
}

}  // namespace

NextPeriod nextPeriod(Time start, Time period, Time now) {
  const std::int64_t passed = now < start ? 0 : (now - start) / period;
  return {start + (passed + 1) * period, static_cast<std::uint64_t>(passed)};
}

PeriodicThread::PeriodicThread(Time period, Work work, const PeriodicThreadOptions& options)
    : period_(period),
      work_(std::move(work)),
      wait_(options.wait ? options.wait : [this](Time until) { return awaitCall(until); }) {
  if (period <= Time{0}) {
    throw std::invalid_argument("period = " + std::to_string(period.count()) +
                                " ns: allowed are periods > 0");
  }
  thread_ = std::thread([this] { run(); });
  refused_scheduler_ = askForFifo(thread_.native_handle(), options.priority);
  if (options.on_force_path) keepOnForceProcessor(thread_.native_handle());
}

PeriodicThread::~PeriodicThread() { stop(); }

void PeriodicThread::stop() {
  stopping_ = true;
  call();  // or it would wait for the next period
  if (thread_.joinable()) thread_.join();
}

/// Calls that come before the thread has seen the first of them are one.
void PeriodicThread::call() {
  if (!is_called_.exchange(true)) called_.post();
}

bool PeriodicThread::awaitCall(Time until) {
  if (!called_.waitUntil(until)) return false;
  is_called_ = false;
  return true;
}

void PeriodicThread::run() {
  // Without SCHED_FIFO the kernel may wake a thread 50 us late to save energy. 1 ns: as exact as
  // it can.
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  touchStack();
  NextPeriod next{steadyNow() + period_, 0};
  Time last = next.start - 2 * period_;  // the first call need not wait
  while (!stopping_) {
    const bool called = wait_(next.start);
    if (stopping_) break;
    if (called && steadyNow() < last + period_ / 2) sleepUntil(last + period_ / 2);
    const Time now = steadyNow();
    lateness_.add(called ? std::chrono::abs(now - last - period_) : now - next.start);
    work_(now);
    periods_.fetch_add(1, std::memory_order_relaxed);
    last = now;
    next = called ? NextPeriod{now + period_ + period_ / 2, 0}
                  : nextPeriod(next.start, period_, steadyNow());
    missed_.fetch_add(next.missed, std::memory_order_relaxed);
  }
}

}  // namespace haptex::realtime
