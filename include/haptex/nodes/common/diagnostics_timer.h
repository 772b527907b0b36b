// When a node says how it is.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>

namespace haptex::nodes {

/// Publishes all of a node's diagnostics once a second, by the steady clock, on the queue of the
/// node's handle. @param diagnostics outlives the timer, or the timer is stopped before
inline ros::SteadyTimer publishOnceASecond(const ros::NodeHandle& node,
                                           diagnostic_updater::Updater& diagnostics) {
  return node.createSteadyTimer(
      ros::WallDuration(1.0),
      [&diagnostics](const ros::SteadyTimerEvent&) { diagnostics.force_update(); });
}

}  // namespace haptex::nodes
