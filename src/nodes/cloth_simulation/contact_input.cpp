#include "haptex/nodes/cloth_simulation/contact_input.h"

#include <stdexcept>
#include <string>

#include "haptex/nodes/cloth_simulation/point_load_messages.h"
#include "haptex/nodes/wire/checked_topics.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

ContactInput::ContactInput(const ros::NodeHandle& node, std::size_t triangle_count)
    : triangle_count_(triangle_count) {
  const boost::function<void(const haptex::ContactForces&)> callback =
      [this](const haptex::ContactForces& message) {
        count_.count("cloth/contact_forces", [&] { take(message); });
      };
  ros::NodeHandle subscribing = node;
  subscribing.setCallbackQueue(&queue_);
  subscriber_ = subscribeChecked(subscribing, "cloth/contact_forces", 1, callback,
                                 ros::TransportHints().tcpNoDelay());
}

void ContactInput::setMesh(std::uint32_t mesh, std::size_t triangle_count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  mesh_ = mesh;
  triangle_count_ = triangle_count;
  loads_.clear();
}

void ContactInput::take(const haptex::ContactForces& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (message.mesh != mesh_) {
    throw std::invalid_argument("mesh = " + std::to_string(message.mesh) + ": allowed is " +
                                std::to_string(mesh_) + ", the number of cloth/mesh");
  }
  loads_.set(pointLoads(message, triangle_count_), realtime::steadyNow());
}

}  // namespace haptex::nodes
