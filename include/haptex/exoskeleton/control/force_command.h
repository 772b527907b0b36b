// The force a fingertip is to feel, with its linearisation, so that it can be evaluated between
// messages at the rate of the servo loop.
#pragma once

#include <Eigen/Core>

namespace haptex::exoskeleton {

/// All in hand_base. Forces act on the person's fingertip.
struct ForceCommand {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< N, at `position` and `velocity`
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, -d force / d position
  Eigen::Matrix3d damping = Eigen::Matrix3d::Zero();    ///< N s/m, -d force / d velocity
};

/// force - stiffness (p - position) - damping (v - velocity), in N.
Eigen::Vector3d evaluate(const ForceCommand& command, const Eigen::Vector3d& p,
                         const Eigen::Vector3d& v);

/// True if every number of it is finite.
bool isFinite(const ForceCommand& command);

}  // namespace haptex::exoskeleton
