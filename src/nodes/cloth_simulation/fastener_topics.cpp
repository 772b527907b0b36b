#include "haptex/nodes/cloth_simulation/fastener_topics.h"

#include <haptex/FastenerEvent.h>

#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {

void FastenerTopics::publish(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                             bool state_due) {
  if (simulation.cloth().fasteners() == nullptr) return;
  if (!states_) advertise();
  if (told_step_ != simulation.computedSteps()) publishEvents(simulation, stamp);
  const bool is_first = !told_step_;
  told_step_ = simulation.computedSteps();
  const bool changed = fill(simulation);
  if (!is_first && !changed && !(state_due && states_.getNumSubscribers() > 0)) return;
  message_.header.stamp = stamp;
  states_.publish(message_);
}

void FastenerTopics::advertise() {
  states_ = node_.advertise<haptex::FastenerStates>("cloth/fasteners", 1, true);
  events_ = node_.advertise<haptex::FastenerEvent>("cloth/fastener_events", 100);
  message_.header.frame_id = fixedFrame();
}

void FastenerTopics::publishEvents(const simulation::SimulatedCloth& simulation,
                                   const ros::Time& stamp) {
  for (const simulation::OpenedFastener& opened : simulation.openedFasteners()) {
    haptex::FastenerEvent event;
    event.header.stamp = stamp;
    event.header.frame_id = fixedFrame();
    event.name = simulation.cloth().fasteners()->all()[opened.fastener].name;
    event.force = opened.force;
    event.simulated_time = simulation.state().time;
    events_.publish(event);
    ++opened_;
    ROS_INFO("Fastener %s opened at %.4g N", event.name.c_str(), event.force);
  }
}

/// @returns whether one is fastened or open that was not so in the message before
bool FastenerTopics::fill(const simulation::SimulatedCloth& simulation) {
  const std::vector<cloth::Fastener>& all = simulation.cloth().fasteners()->all();
  bool changed = message_.fasteners.size() != all.size();
  message_.fasteners.resize(all.size());
  std::size_t open = 0;
  for (std::size_t f = 0; f < all.size(); ++f) {
    haptex::FastenerState& state = message_.fasteners[f];
    const bool fastened = simulation.isFastened(f);
    changed = changed || (state.fastened != 0) != fastened;
    state.name = all[f].name;
    state.kind = nameOf(all[f].kind);
    state.fastened = fastened;
    state.force = simulation.fastenerForce(f);
    open += fastened ? 0 : 1;
  }
  all_ = all.size();
  open_ = open;
  return changed;
}

}  // namespace haptex::nodes
