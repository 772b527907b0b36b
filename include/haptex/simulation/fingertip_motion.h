// Where a fingertip is and how it moves.
#pragma once

#include <Eigen/Geometry>

namespace haptex::simulation {

/// By the axes of hand_base.
struct FingertipTwist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
};

/// By the axes of hand_base.
struct FingertipMotion {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< m
  FingertipTwist twist;
};

}  // namespace haptex::simulation
