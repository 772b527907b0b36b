// Service calls from a graphical program, which must not wait for the answer.
#pragma once

#include <ros/names.h>
#include <ros/service.h>

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "haptex/base/clock.h"

namespace haptex::nodes {

/// How a call has ended.
struct Answer {
  std::string service;  ///< as it was called
  bool success = false;
  std::string message;  ///< what was done, or why it was not
};

/// Each call runs on a thread of its own, which nobody waits for: a service that hangs keeps its
/// thread and nothing else. Of one service there is one call at a time.
class ServiceCalls {
 public:
  /// @param service as roscpp resolves it @param request of a service that answers success and
  /// message
  /// @returns false, and nothing is called, while an earlier call of it has not been answered
  template <typename Service>
  bool call(const std::string& service, const typename Service::Request& request) {
    return run(service, [service, request] {
      Service exchange;
      exchange.request = request;
      if (!ros::service::call(service, exchange)) {
        return Answer{service, false,
                      ros::names::resolve(service) + " does not answer: is its node running?"};
      }
      return Answer{service, exchange.response.success != 0, exchange.response.message};
    });
  }

  /// What has been answered since the last time, in this order.
  std::vector<Answer> answers();

  /// Services that have not answered for longer than kPatience, in one line; empty if none.
  std::string waiting() const;

  static constexpr base::Time kPatience = std::chrono::seconds(2);

 private:
  struct Shared {
    std::mutex mutex;  // guards all of it
    std::deque<Answer> answers;
    std::map<std::string, base::Time> begun;  // steady clock, of calls that are not answered
  };

  bool run(const std::string& service, std::function<Answer()> work);

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();  // with the threads
};

}  // namespace haptex::nodes
