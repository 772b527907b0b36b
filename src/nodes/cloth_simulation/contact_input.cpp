#include "haptex/nodes/cloth_simulation/contact_input.h"

#include <exception>

#include "haptex/nodes/cloth_simulation/point_load_messages.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

ContactInput::ContactInput(const ros::NodeHandle& node, std::size_t triangle_count)
    : triangle_count_(triangle_count) {
  const boost::function<void(const haptex::ContactForces&)> callback =
      [this](const haptex::ContactForces& message) { receive(message); };
  ros::NodeHandle subscribing = node;
  subscribing.setCallbackQueue(&queue_);
  subscriber_ = subscribing.subscribe<haptex::ContactForces>(
      "cloth/contact_forces", 1, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

ContactInputStatus ContactInput::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void ContactInput::receive(const haptex::ContactForces& message) {
  std::string why;
  try {
    loads_.set(pointLoads(message, triangle_count_), realtime::steadyNow());
  } catch (const std::exception& error) {
    why = error.what();
    ROS_WARN_THROTTLE(1.0, "cloth/contact_forces refused: %s", error.what());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ++(why.empty() ? status_.taken : status_.refused);
  if (!why.empty()) status_.refused_why = why;
}

}  // namespace haptex::nodes
