#include "haptex/exoskeleton/control/workspace.h"

#include <algorithm>
#include <limits>

namespace haptex::exoskeleton {

using Eigen::Vector3d;

double distanceToWorkspaceRim(const Vector3d& place) {
  return 0.5 * kWorkspaceSide - (place - kWorkspaceMiddle).cwiseAbs().maxCoeff();
}

ReachRim::ReachRim(const std::string& urdf, Finger finger)
    : kinematics_(urdf, finger), reach_(urdf, finger) {}

double ReachRim::distance(const JointVector& joint_angles) {
  const Configuration configuration = kinematics_.configuration(joint_angles);
  if (configuration.singular) return 0.0;
  const MotorVector angles = kinematics_.motorAngles(joint_angles);
  const Vector3d tip = kinematics_.fingertip(joint_angles).translation();
  double nearest = std::numeric_limits<double>::infinity();
  for (int motor = 0; motor < kMotors; ++motor) {
    for (const double limit : {reach_.lowest()[motor], reach_.highest()[motor]}) {
      const Vector3d place = reach_.nearestHolding(motor, limit, tip, angles).position;
      nearest = std::min(nearest, (place - tip).norm());
    }
  }
  return configuration.within_limits ? nearest : -nearest;
}

std::vector<Vector3d> ReachRim::surface(int cells) {
  std::vector<Vector3d> corners;
  const auto place = [&](int fixed, bool high, int i, int j) -> Vector3d {
    MotorVector share = MotorVector::Constant(high ? 1.0 : 0.0);
    share[(fixed + 1) % kMotors] = static_cast<double>(i) / cells;
    share[(fixed + 2) % kMotors] = static_cast<double>(j) / cells;
    const MotorVector angles =
        reach_.lowest() + share.cwiseProduct(reach_.highest() - reach_.lowest());
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
