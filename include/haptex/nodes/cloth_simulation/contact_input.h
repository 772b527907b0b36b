// Contact forces on the cloth from the topic cloth/contact_forces.
#pragma once

#include <haptex/ContactForces.h>
#include <ros/ros.h>

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/simulation/newest_loads.h"

namespace haptex::nodes {

/// Subscribes to cloth/contact_forces below the namespace of `node`. A message that is refused,
/// also for being of another mesh, is counted and changes nothing, not even the age of the loads
/// that act.
class ContactInput {
 public:
  /// @param triangle_count of the cloth, whose mesh has the number 0
  ContactInput(const ros::NodeHandle& node, std::size_t triangle_count);

  /// There are no loads from now on until those of another mesh come.
  /// @param mesh its number
  void setMesh(std::uint32_t mesh, std::size_t triangle_count);

  simulation::NewestLoads& loads() { return loads_; }
  InputStatus status() const { return count_.status(); }

 private:
  void take(const haptex::ContactForces& message);

  simulation::NewestLoads loads_;
  std::mutex mutex_;  // guards the following, and that loads_ are of this mesh
  std::uint32_t mesh_ = 0;
  std::size_t triangle_count_;
  InputCount count_;
  ImmediateQueue queue_;
  ros::Subscriber subscriber_;
};

}  // namespace haptex::nodes
