#include "haptex/exoskeleton/control/fingertip_reach.h"

#include <Eigen/LU>
#include <algorithm>

namespace haptex::exoskeleton {
namespace {

using Eigen::Vector3d;

constexpr int kMaxSteps = 100;
constexpr int kGrid = 15;          // places along each motor's range
constexpr double kSettled = 1e-9;  // m, an improvement that is none

}  // namespace

FingertipReach::FingertipReach(const std::string& urdf, Finger finger) : kinematics_(urdf, finger) {
  lowest_ = kinematics_.motorAngles(kinematics_.lowerLimits());
  highest_ = kinematics_.motorAngles(kinematics_.upperLimits());
  // The last joint follows the one before it: angle = offset + ratio * that of the last motor.
  const int last = kJoints - 1;
  const double offset = kinematics_.jointAngles(MotorVector::Zero())[last];
  const double ratio = kinematics_.jointAngles(MotorVector::Unit(kMotors - 1))[last] - offset;
  if (ratio != 0.0) {
    const double low = (kinematics_.lowerLimits()[last] - offset) / ratio;
    const double high = (kinematics_.upperLimits()[last] - offset) / ratio;
    lowest_[kMotors - 1] = std::max(lowest_[kMotors - 1], std::min(low, high));
    highest_[kMotors - 1] = std::min(highest_[kMotors - 1], std::max(low, high));
  }
  for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
    const Eigen::Vector3d share =
        Eigen::Vector3i(i % kGrid, i / kGrid % kGrid, i / (kGrid * kGrid)).cast<double>();
    Place place;
    place.motor_angles = lowest_ + share.cwiseProduct(highest_ - lowest_) / (kGrid - 1);
    place.position =
        kinematics_.fingertip(kinematics_.jointAngles(place.motor_angles)).translation();
    grid_.push_back(place);
  }
}

FingertipReach::Place FingertipReach::nearest(const Vector3d& target, const MotorVector& start) {
  const Place first = descend(target, start, lowest_, highest_);
  const double distance = (first.position - target).norm();
  if (distance <= kTolerance) return first;
  const auto nearer = [&](const Place& a, const Place& b) {
    return (a.position - target).squaredNorm() < (b.position - target).squaredNorm();
  };
  const Place second =
      descend(target, std::min_element(grid_.begin(), grid_.end(), nearer)->motor_angles, lowest_,
              highest_);
  return (second.position - target).norm() < distance ? second : first;
}

FingertipReach::Place FingertipReach::nearestHolding(int motor, double angle,
                                                     const Vector3d& target,
                                                     const MotorVector& start) {
  MotorVector lowest = lowest_, highest = highest_;
  lowest[motor] = highest[motor] = angle;
  return descend(target, start, lowest, highest);
}

// Levenberg-Marquardt on the angles that are not held at a limit by a gradient that points out.
FingertipReach::Place FingertipReach::descend(const Vector3d& target, const MotorVector& start,
                                              const MotorVector& lowest,
                                              const MotorVector& highest) {
  Place place;
  place.motor_angles = start.cwiseMax(lowest).cwiseMin(highest);
  JointVector joints = kinematics_.jointAngles(place.motor_angles);
  place.position = kinematics_.fingertip(joints).translation();
  double distance = (target - place.position).norm();
  double caution = 1e-4;  // relative to the largest diagonal element
  for (int step = 0; step < kMaxSteps && distance > 0.1 * kTolerance; ++step) {
    Eigen::Matrix3d jacobian = kinematics_.motorJacobian(joints);
    const MotorVector downhill = jacobian.transpose() * (target - place.position);
    for (int i = 0; i < kMotors; ++i) {
      const bool at_lowest = place.motor_angles[i] <= lowest[i] && downhill[i] < 0.0;
      const bool at_highest = place.motor_angles[i] >= highest[i] && downhill[i] > 0.0;
      if (at_lowest || at_highest) jacobian.col(i).setZero();
    }
    Eigen::Matrix3d normal = jacobian.transpose() * jacobian;
    const double scale = normal.diagonal().maxCoeff();
    if (!(scale > 0.0)) break;
    normal.diagonal().array() += caution * scale;
    const MotorVector change =
        normal.inverse() * (jacobian.transpose() * (target - place.position));
    const MotorVector tried = (place.motor_angles + change).cwiseMax(lowest).cwiseMin(highest);
    const JointVector tried_joints = kinematics_.jointAngles(tried);
    const Vector3d position = kinematics_.fingertip(tried_joints).translation();
    const double tried_distance = (target - position).norm();
    if (tried_distance < distance) {
      const bool settled = distance - tried_distance < kSettled;
      place = {tried, position};
      joints = tried_joints;
      distance = tried_distance;
      if (settled) break;
      caution = std::max(0.1 * caution, 1e-9);
    } else {
      caution *= 10.0;
      if (caution > 1e9) break;
    }
  }
  return place;
}

}  // namespace haptex::exoskeleton
