// Time as the exoskeleton room counts it.
#pragma once

#include <chrono>

namespace haptex::exoskeleton {

/// Since any fixed moment, of a clock that is never set: a steady clock's epoch, or the start of a
/// simulation. No class of this room reads a clock; time is handed in.
using Time = std::chrono::nanoseconds;

constexpr double seconds(Time time) { return std::chrono::duration<double>(time).count(); }

}  // namespace haptex::exoskeleton
