// How the hand is held, by tf: which way the links weigh, and where the fingertips are in world.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <mutex>
#include <optional>
#include <string>

#include "haptex/exoskeleton/driver/driver_loop.h"

namespace haptex::nodes {

/// Looks at the tf from world to hand_base at 100 Hz, on the queue of its node handle, and tells
/// the driver's loop. Where there is none, or one older than HandGravity::kTimeout, the loop is
/// told nothing and the weight of the links is soon not held any more.
class HandWatch {
 public:
  /// @param loop outlives this
  HandWatch(const ros::NodeHandle& node, exoskeleton::DriverLoop& loop);

  void stop() { timer_.stop(); }

  /// Pose of hand_base in world (m), if it is known now. By any thread.
  std::optional<Eigen::Isometry3d> hand() const;

  /// Whether the weight of the links is held, and why not.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void look();

  ros::NodeHandle node_;
  exoskeleton::DriverLoop& loop_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  mutable std::mutex mutex_;  // guards the next
  std::optional<Eigen::Isometry3d> hand_;
  std::string trouble_;
  ros::SteadyTimer timer_;
};

}  // namespace haptex::nodes
