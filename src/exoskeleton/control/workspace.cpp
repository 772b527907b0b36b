#include "haptex/exoskeleton/control/workspace.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace haptex::exoskeleton {

using Eigen::Vector3d;

double distanceToWorkspaceRim(const Vector3d& place) {
  return 0.5 * kWorkspaceSide - (place - kWorkspaceMiddle).cwiseAbs().maxCoeff();
}

ReachRim::ReachRim(const std::string& urdf, Finger finger) : kinematics_(urdf, finger) {
  const FingertipReach reach(urdf, finger);
  lowest_ = reach.lowest();
  highest_ = reach.highest();
}

double ReachRim::distance(const JointVector& joint_angles) {
  const MotorVector angles = kinematics_.motorAngles(joint_angles);
  if (kinematics_.configuration(joint_angles).singular) return 0.0;
  // Row i is the gradient of the angle of motor i over the place of the fingertip.
  const Eigen::Matrix3d gradients = kinematics_.motorJacobian(joint_angles).inverse();
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMotors; ++i) {
    const double left = std::min(angles[i] - lowest_[i], highest_[i] - angles[i]);
    nearest = std::min(nearest, left / gradients.row(i).norm());
  }
  return nearest;
}

std::vector<Vector3d> ReachRim::surface(int cells) {
  std::vector<Vector3d> corners;
  const auto place = [&](int fixed, bool high, int i, int j) -> Vector3d {
    MotorVector share = MotorVector::Constant(high ? 1.0 : 0.0);
    share[(fixed + 1) % kMotors] = static_cast<double>(i) / cells;
    share[(fixed + 2) % kMotors] = static_cast<double>(j) / cells;
    const MotorVector angles = lowest_ + share.cwiseProduct(highest_ - lowest_);
    return kinematics_.fingertip(kinematics_.jointAngles(angles)).translation();
  };
  for (int face = 0; face < 2 * kMotors; ++face) {
    for (int cell = 0; cell < cells * cells; ++cell) {
      const int i = cell % cells, j = cell / cells;
      const auto at = [&](int di, int dj) {
        return place(face / 2, face % 2 == 1, i + di, j + dj);
      };
      for (const Vector3d& corner : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)}) {
        corners.push_back(corner);
      }
    }
  }
  return corners;
}

}  // namespace haptex::exoskeleton
