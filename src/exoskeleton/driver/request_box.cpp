#include "haptex/exoskeleton/driver/request_box.h"

#include <utility>

namespace haptex::exoskeleton {

Refusal RequestBox::ask(DriverRequest request) {
  const std::lock_guard<std::mutex> lock(askers_);
  request_ = request;
  state_.store(State::kAsked, std::memory_order_release);
  if (!answered_.waitFor(kPatience)) {
    State expected = State::kAsked;
    if (state_.compare_exchange_strong(expected, State::kIdle)) {
      return "the loop has not answered within 0.5 s: the machine is too busy, or it is ending";
    }
    // The loop is at it, which takes it less than a period.
    while (!answered_.waitFor(kPatience)) {
    }
  }
  state_.load(std::memory_order_acquire);  // the loop's kIdle, stored before it answered
  return std::move(refusal_);
}

bool RequestBox::take(DriverRequest& request) {
  State expected = State::kAsked;
  if (!state_.compare_exchange_strong(expected, State::kTaken)) return false;
  request = request_;
  return true;
}

void RequestBox::answer(Refusal refusal) {
  refusal_ = std::move(refusal);
  state_.store(State::kIdle, std::memory_order_release);
  answered_.post();
}

}  // namespace haptex::exoskeleton
