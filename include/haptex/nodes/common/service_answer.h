// What the services that can refuse a request have in common.
#pragma once

#include <ros/console.h>

#include <exception>

namespace haptex::nodes {

/// Runs `action`, which returns the message of success; what it throws is the refusal.
/// @returns true: there is a response
template <typename Response, typename Action>
bool answer(const char* service, Response& response, const Action& action) {
  try {
    response.message = action();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = false;
    ROS_WARN("%s refused: %s", service, error.what());
  }
  return true;
}

}  // namespace haptex::nodes
