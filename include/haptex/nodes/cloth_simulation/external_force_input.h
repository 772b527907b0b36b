// User-defined forces on the cloth from the topic cloth/external_forces.
#pragma once

#include <haptex/ExternalForces.h>
#include <ros/ros.h>

#include <cstddef>

#include "haptex/nodes/common/immediate_queue.h"
#include "haptex/nodes/common/input_count.h"
#include "haptex/simulation/force_sources.h"

namespace haptex::nodes {

/// @throws std::invalid_argument if the frame is not fixedFrame(); what else is wrong is for
///   ForceSources::set()
simulation::ParticleForces particleForces(const haptex::ExternalForces& message);

/// Subscribes to cloth/external_forces below the namespace of `node`. A message that is refused is
/// counted and changes nothing, not even how long the forces of its source act.
class ExternalForceInput {
 public:
  /// @param particle_count of the cloth
  ExternalForceInput(const ros::NodeHandle& node, std::size_t particle_count);

  simulation::ForceSources& sources() { return sources_; }
  InputStatus status() const { return count_.status(); }

 private:
  simulation::ForceSources sources_;
  InputCount count_;
  ImmediateQueue queue_;
  ros::Subscriber subscriber_;
};

}  // namespace haptex::nodes
