// Contact forces on the cloth from the topic cloth/contact_forces.
#pragma once

#include <haptex/ContactForces.h>
#include <ros/ros.h>

#include <cstddef>

#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/simulation/newest_loads.h"

namespace haptex::nodes {

/// Subscribes to cloth/contact_forces below the namespace of `node`. A message that is refused is
/// counted and changes nothing, not even the age of the loads that act.
class ContactInput {
 public:
  /// @param triangle_count of the cloth
  ContactInput(const ros::NodeHandle& node, std::size_t triangle_count);

  simulation::NewestLoads& loads() { return loads_; }
  InputStatus status() const { return count_.status(); }

 private:
  simulation::NewestLoads loads_;
  InputCount count_;
  ImmediateQueue queue_;
  ros::Subscriber subscriber_;
};

}  // namespace haptex::nodes
