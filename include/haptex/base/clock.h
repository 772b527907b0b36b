// Time as every room counts it.
#pragma once

#include <chrono>

namespace haptex::base {

/// Since any fixed moment, of a clock that is never set: a steady clock's epoch, or the start of a
/// simulation. Only realtime/steady_clock.h reads a clock; to all else time is handed in.
using Time = std::chrono::nanoseconds;

constexpr double seconds(Time time) { return std::chrono::duration<double>(time).count(); }
constexpr double milliseconds(Time time) { return 1e3 * seconds(time); }

}  // namespace haptex::base
