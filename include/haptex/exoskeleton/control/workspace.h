// The workspace of the hand, and what a fingertip reaches of it while the hand stays where it is.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/exoskeleton/control/fingertip_reach.h"

namespace haptex::exoskeleton {

/// m, a cube in world around the middle of a sample of 200 mm that hangs from the origin:
/// Magnenat-Thalmann et al., From physics-based simulation to the touching of textiles: the HAPTEX
/// project, evaluate such a sample in a workspace of 400 mm.
constexpr double kWorkspaceSide = 0.4;
inline const Eigen::Vector3d kWorkspaceMiddle(0.0, 0.0, -0.1);

/// m, to the nearest face of the workspace; negative outside.
/// @param place m, in world
double distanceToWorkspaceRim(const Eigen::Vector3d& place);

/// The rim of what a fingertip reaches: where a joint, the coupled one included, is at a limit. Not
/// thread-safe.
class ReachRim {
 public:
  /// @throws std::invalid_argument as FingerKinematics
  ReachRim(const std::string& urdf, Finger finger);

  /// m, to the nearest place of the fingertip with a joint at a limit; zero in a singular pose, as
  /// negative with a joint outside of its limits.
  double distance(const JointVector& joint_angles);

  /// Corners of triangles (m, in hand_base), three by three: the places of the fingertip with one
  /// motor at a limit, the others in steps. @param cells steps of each motor's range, > 0
  std::vector<Eigen::Vector3d> surface(int cells);

 private:
  FingerKinematics kinematics_;
  FingertipReach reach_;
};

/// Whether to warn of a rim: from closer than `enter` (m) on until farther than `leave` (m), so
/// that a warning does not flicker.
class RimWarning {
 public:
  RimWarning(double enter, double leave) : enter_(enter), leave_(leave) {}

  /// @param distance m; one that is not a number warns
  bool update(double distance) {
    warns_ = !(distance > (warns_ ? leave_ : enter_));
    return warns_;
  }

 private:
  double enter_, leave_;  // m
  bool warns_ = false;
};

}  // namespace haptex::exoskeleton
