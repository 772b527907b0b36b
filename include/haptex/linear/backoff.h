// When what has failed is tried again.
#pragma once

#include <algorithm>

namespace haptex::linear {

/// Counts the times that something is left out after it has failed: a first number of them, twice
/// as many after each further failure in a row, up to a limit.
class Backoff {
 public:
  Backoff(int first, int most) : first_(first), most_(most), next_(first) {}

  /// Whether it is to be left out still.
  bool holds() const { return left_ > 0; }
  /// It was left out once.
  void pass() { --left_; }
  void failed() {
    left_ = next_;
    next_ = std::min(2 * next_, most_);
  }
  void succeeded() { next_ = first_; }

 private:
  int first_;
  int most_;
  int next_;
  int left_ = 0;
};

}  // namespace haptex::linear
