// All values from one thread to another, in order, without the writer ever waiting.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "haptex/base/clock.h"
#include "haptex/realtime/semaphore.h"

namespace haptex::realtime {

/// One thread writes, one reads. The writer neither waits nor allocates, if copying a T does not:
/// what comes while the ring is full is lost and counted.
template <typename T, std::size_t kCapacity>
class Ring {
 public:
  /// By the writer only.
  void write(const T& value) {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == kCapacity) {
      lost_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    values_[written % kCapacity] = value;
    written_.store(written + 1, std::memory_order_release);
    filled_.post();
  }

  /// By the reader only: takes the oldest value, waiting for one if there is none.
  /// @returns false if none came in time
  bool read(T& value, base::Time patience) {
    if (!filled_.waitFor(patience)) return false;
    const std::uint64_t read = read_.load(std::memory_order_relaxed);
    written_.load(std::memory_order_acquire);  // beyond read, the semaphore says so
    value = values_[read % kCapacity];
    read_.store(read + 1, std::memory_order_release);
    return true;
  }

  /// By any thread: values lost since the construction.
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<T, kCapacity> values_{};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> read_{0};
  std::atomic<std::uint64_t> lost_{0};
  Semaphore filled_;
};

}  // namespace haptex::realtime
