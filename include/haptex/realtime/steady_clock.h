// The clock of the exoskeleton's nodes, which nobody can set.
#pragma once

#include <cerrno>
#include <ctime>

#include "haptex/base/clock.h"

namespace haptex::realtime {

/// CLOCK_MONOTONIC.
inline base::Time steadyNow() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// @param time >= 0
inline timespec toTimespec(base::Time time) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(time);
  timespec converted{};
  converted.tv_sec = whole.count();
  converted.tv_nsec = (time - whole).count();
  return converted;
}

/// Until a time of the steady clock, >= 0.
inline void sleepUntil(base::Time time) {
  const timespec end = toTimespec(time);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &end, nullptr) == EINTR) {
  }
}

}  // namespace haptex::realtime
