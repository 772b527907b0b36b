// Where the fingertips are in the workspace and in what they reach of it.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/control/workspace.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::nodes {

/// Diagnostics of a fingertip, and exoskeleton/workspace_markers (visualization_msgs/MarkerArray):
/// the workspace in world and what each fingertip reaches in hand_base. The markers are computed
/// for each subscriber once, when it comes: nothing of them changes. The diagnostics are for one
/// thread.
class WorkspaceWatch {
 public:
  /// Warnings begin closer to a rim than the first and end farther than the second (m).
  static constexpr double kNearReach = 0.003, kFarFromReach = 0.005;
  static constexpr double kNearRim = 0.02, kFarFromRim = 0.03;

  /// @throws std::invalid_argument as exoskeleton::FingerKinematics
  WorkspaceWatch(const ros::NodeHandle& node, const std::string& urdf);

  /// @param hand pose of hand_base in world, if it is known
  void diagnose(exoskeleton::Finger finger, const exoskeleton::FingerMeasurement& measured,
                bool is_homed, const std::optional<Eigen::Isometry3d>& hand,
                diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  struct Side {
    exoskeleton::ReachRim rim;
    exoskeleton::RimWarning reach{kNearReach, kFarFromReach};
    exoskeleton::RimWarning workspace{kNearRim, kFarFromRim};
  };

  ros::NodeHandle node_;
  exoskeleton::PerFinger<Side> sides_;
  ros::Publisher marker_publisher_;
};

}  // namespace haptex::nodes
