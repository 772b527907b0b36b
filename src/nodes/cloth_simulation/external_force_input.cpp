#include "haptex/nodes/cloth_simulation/external_force_input.h"

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/wire/checked_topics.h"

namespace haptex::nodes {

simulation::ParticleForces particleForces(const haptex::ExternalForces& message) {
  requireFixedFrame(message.header);
  return {message.particles, fromMessage(message.forces), message.lifetime};
}

ExternalForceInput::ExternalForceInput(const ros::NodeHandle& node, std::size_t particle_count)
    : sources_(particle_count) {
  const boost::function<void(const haptex::ExternalForces&)> callback =
      [this](const haptex::ExternalForces& message) {
        count_.count("cloth/external_forces",
                     [&] { sources_.set(message.source, particleForces(message)); });
      };
  ros::NodeHandle subscribing = node;
  subscribing.setCallbackQueue(&queue_);
  subscriber_ =
      subscribeChecked(subscribing, "cloth/external_forces", simulation::ForceSources::kMax,
                       callback, ros::TransportHints().tcpNoDelay());
}

}  // namespace haptex::nodes
