// Publishes what the fasteners of the cloth do.
#pragma once

#include <haptex/FastenerStates.h>
#include <ros/ros.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/simulation/simulated_cloth.h"

namespace haptex::nodes {

/// How many fasteners there are, for diagnostics.
struct FastenerCount {
  std::size_t all = 0;
  std::size_t open = 0;
  std::uint64_t opened = 0;  ///< by themselves, since the start
};

/// In a scene with fasteners publishes
///   cloth/fasteners (FastenerStates, latched): when one opens or is fastened, and to subscribers
///   with every state;
///   cloth/fastener_events (FastenerEvent): for each that opens by itself.
/// In one without, nothing.
class FastenerTopics {
 public:
  explicit FastenerTopics(const ros::NodeHandle& node) : node_(node) {}

  /// After a step, or what changes the cloth between steps; by the simulation's thread.
  /// @param state_due whether the state is published, too
  void publish(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
               bool state_due);
  /// Another cloth is published from now on; likewise.
  void restart() { told_step_.reset(); }

  /// By any thread.
  FastenerCount count() const { return {all_, open_, opened_}; }

 private:
  void advertise();
  void publishEvents(const simulation::SimulatedCloth& simulation, const ros::Time& stamp);
  bool fill(const simulation::SimulatedCloth& simulation);

  ros::NodeHandle node_;
  ros::Publisher states_;  // empty before there is a fastener
  ros::Publisher events_;  // likewise
  haptex::FastenerStates message_;
  // SimulatedCloth::computedSteps() whose events are published; nothing: of no step of this cloth.
  std::optional<std::uint64_t> told_step_;
  std::atomic<std::size_t> all_{0}, open_{0};
  std::atomic<std::uint64_t> opened_{0};
};

}  // namespace haptex::nodes
