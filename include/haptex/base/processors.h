// How many processors a program may use.
#pragma once

#include <algorithm>
#include <thread>

namespace haptex::base {

/// Of the machine, at least 1.
inline int processorCount() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace haptex::base
