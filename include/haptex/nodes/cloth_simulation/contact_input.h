// Contact forces on the cloth from the topic cloth/contact_forces.
#pragma once

#include <haptex/ContactForces.h>
#include <ros/ros.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/simulation/newest_loads.h"

namespace haptex::nodes {

/// Since the construction.
struct ContactInputStatus {
  std::uint64_t taken = 0;    ///< messages, no unit
  std::uint64_t refused = 0;  ///< likewise
  std::string refused_why;    ///< the last one
};

/// Subscribes to cloth/contact_forces below the namespace of `node`. A message that is refused is
/// counted and changes nothing, not even the age of the loads that act.
class ContactInput {
 public:
  /// @param triangle_count of the cloth
  ContactInput(const ros::NodeHandle& node, std::size_t triangle_count);

  simulation::NewestLoads& loads() { return loads_; }
  ContactInputStatus status() const;

 private:
  void receive(const haptex::ContactForces& message);

  const std::size_t triangle_count_;
  simulation::NewestLoads loads_;
  mutable std::mutex mutex_;  // guards the following
  ContactInputStatus status_;
  ImmediateQueue queue_;
  ros::Subscriber subscriber_;
};

}  // namespace haptex::nodes
