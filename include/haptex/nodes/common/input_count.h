// How many messages were taken and refused.
#pragma once

#include <ros/console.h>

#include <cstdint>
#include <exception>
#include <mutex>
#include <string>

namespace haptex::nodes {

/// Since the construction.
struct InputStatus {
  std::uint64_t taken = 0;    ///< messages, no unit
  std::uint64_t refused = 0;  ///< likewise
  std::string refused_from;   ///< topic of the last one
  std::string refused_why;    ///< what was wrong with it
};

/// By any thread.
class InputCount {
 public:
  /// Runs `take` for a message of a topic; what it throws is the refusal, which is told at most
  /// once a second.
  template <typename Take>
  void count(const std::string& topic, const Take& take) {
    std::string why;
    try {
      take();
    } catch (const std::exception& error) {
      why = error.what();
      ROS_WARN_THROTTLE(1.0, "%s refused: %s", topic.c_str(), error.what());
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    ++(why.empty() ? status_.taken : status_.refused);
    if (why.empty()) return;
    status_.refused_from = topic;
    status_.refused_why = why;
  }

  InputStatus status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }

 private:
  mutable std::mutex mutex_;  // guards the following
  InputStatus status_;
};

}  // namespace haptex::nodes
