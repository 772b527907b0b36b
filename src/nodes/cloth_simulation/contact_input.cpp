#include "haptex/nodes/cloth_simulation/contact_input.h"

#include "haptex/nodes/cloth_simulation/point_load_messages.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::nodes {

ContactInput::ContactInput(const ros::NodeHandle& node, std::size_t triangle_count) {
  const boost::function<void(const haptex::ContactForces&)> callback =
      [this, triangle_count](const haptex::ContactForces& message) {
        count_.count("cloth/contact_forces", [&] {
          loads_.set(pointLoads(message, triangle_count), realtime::steadyNow());
        });
      };
  ros::NodeHandle subscribing = node;
  subscribing.setCallbackQueue(&queue_);
  subscriber_ = subscribing.subscribe<haptex::ContactForces>(
      "cloth/contact_forces", 1, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

}  // namespace haptex::nodes
