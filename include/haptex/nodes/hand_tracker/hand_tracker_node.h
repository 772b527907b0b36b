// The node hand_tracker: the poses of a tracker as the tf of the exoskeleton's hand base.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "haptex/nodes/common/input_count.h"
#include "haptex/nodes/hand_tracker/tracker_filter.h"

namespace haptex::nodes {

/// Subscribes to tracker/pose (geometry_msgs/PoseStamped) of a body that is fixed to the hand, and
/// publishes the tf from world to hand_base for each pose that TrackerFilter believes, with its
/// stamp. Without poses there is no tf, and forces end. ~mounting is the pose of hand_base in the
/// frame of the body, see parseMounting(); if it is not set, they are the same. All runs on the one
/// thread that spins.
class HandTrackerNode {
 public:
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  HandTrackerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  /// Afterwards only to be destroyed.
  void stop();

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void receive(const geometry_msgs::PoseStamped& message);
  void diagnose(Status& status);

  ros::NodeHandle node_;
  TrackerFilter filter_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Subscriber subscriber_;
  InputCount input_;
  InputStatus diagnosed_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer diagnostics_timer_;
};

}  // namespace haptex::nodes
