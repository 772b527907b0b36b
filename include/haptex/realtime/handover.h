// Hands a thing to a thread that neither waits, allocates nor frees, and takes it back.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace haptex::realtime {

/// One thread offers, another one takes. There is one thing at a time: the next can be offered when
/// the last has been taken and freed again.
template <typename T>
class Handover {
 public:
  /// By the giver: frees what the taker is done with. @returns whether the next can be offered
  bool isFree() {
    if (turn_.load(std::memory_order_acquire) == Turn::kTaker) return false;
    value_.reset();
    return true;
  }
  /// By the giver, only if isFree().
  void offer(std::unique_ptr<T> value) {
    value_ = std::move(value);
    turn_.store(Turn::kTaker, std::memory_order_release);
  }

  /// By the taker: what was offered, to be used and changed until finish(); null if there is
  /// nothing.
  T* offered() {
    return turn_.load(std::memory_order_acquire) == Turn::kTaker ? value_.get() : nullptr;
  }
  /// By the taker: the giver may free what is left of it.
  void finish() { turn_.store(Turn::kGiver, std::memory_order_release); }

 private:
  enum class Turn { kGiver, kTaker };

  std::atomic<Turn> turn_{Turn::kGiver};
  std::unique_ptr<T> value_;  // of the one whose turn it is
};

}  // namespace haptex::realtime
