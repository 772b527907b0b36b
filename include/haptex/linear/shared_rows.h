// Loops over many rows, shared by threads.
#pragma once

#include <algorithm>

#include "haptex/linear/thread_pool.h"

namespace haptex::linear {

/// Rows that one thread takes at a time.
constexpr int kSharedRows = 4096;
inline int sharesOf(int count) { return (count + kSharedRows - 1) / kSharedRows; }

/// Calls function(begin, end) for parts of [0, count), of kSharedRows and what is left, that
/// threads share. The parts are the same for any number of threads: part i begins at
/// i kSharedRows. @param pool may be null
template <typename Function>
void shareRows(ThreadPool* pool, int count, const Function& function) {
  runTasks(pool, sharesOf(count), [&](int part, int) {
    function(kSharedRows * part, std::min(count, kSharedRows * (part + 1)));
  });
}

}  // namespace haptex::linear
