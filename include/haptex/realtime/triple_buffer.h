// The newest value from one thread to another, without either ever waiting.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace haptex::realtime {

/// One thread writes, one reads. What is not read in time is replaced. Neither waits nor allocates,
/// if copying a T does not.
template <typename T>
class TripleBuffer {
 public:
  /// By the writer only: hands over a value.
  void write(const T& value) {
    values_[back_] = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  }

  /// By the reader only: takes the newest value, if there is one since the last call.
  bool update() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & ~kFresh;
    return true;
  }

  /// By the reader only: the value taken by the last update(), a T() before the first.
  const T& value() const { return values_[front_]; }

 private:
  static constexpr std::uint8_t kFresh = 4;  // flag beside an index of 0 to 2

  std::array<T, 3> values_{};
  std::uint8_t back_ = 0;                // the writer's
  std::atomic<std::uint8_t> middle_{1};  // in between, with kFresh if it was written last
  std::uint8_t front_ = 2;               // the reader's
};

}  // namespace haptex::realtime
