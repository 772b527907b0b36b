#include "haptex/oracles/experiments/pinch.h"

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptex::oracles {
namespace {

using base::Finger;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using exoskeleton::Configuration;
using exoskeleton::FingerKinematics;
using exoskeleton::JointVector;
using exoskeleton::kMotors;
using exoskeleton::MotorVector;

constexpr int kThumbSteps = 12;  // per joint
constexpr int kNewtonSteps = 20;
constexpr double kMet = 1e-9;         // m
constexpr double kStep = 1e-4;        // rad of a motor, for differences
constexpr double kLongestStep = 5.0;  // rad of a motor in a Newton step: a bit more than 20 degrees

/// Pose of <finger>_tactile in <finger>_tip.
Isometry3d tactileInTip(const std::string& urdf, Finger finger) {
  const std::string prefix = base::name(finger);
  const auto model = urdf::parseURDF(urdf);
  const auto link = model->getLink(prefix + "_tactile");
  if (!link || !link->parent_joint || link->parent_joint->type != urdf::Joint::FIXED ||
      link->parent_joint->parent_link_name != prefix + "_tip") {
    throw std::invalid_argument("exoskeleton, " + prefix + ": no link " + prefix +
                                "_tactile is fixed to " + prefix + "_tip");
  }
  const urdf::Pose& pose = link->parent_joint->parent_to_joint_origin_transform;
  const auto& [x, y, z, w] = pose.rotation;
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         Eigen::Quaterniond(w, x, y, z);
}

/// A finger and its pad.
class Digit {
 public:
  Digit(const std::string& urdf, Finger finger)
      : kinematics(urdf, finger), tactile_in_tip(tactileInTip(urdf, finger)) {}

  Vector3d meetingPoint(const JointVector& angles, Meeting meeting) {
    const Isometry3d tip = kinematics.fingertip(angles);
    return meeting == Meeting::kTips ? Vector3d(tip.translation())
                                     : Vector3d((tip * tactile_in_tip).translation());
  }

  Vector3d padNormal(const JointVector& angles) {
    return (kinematics.fingertip(angles) * tactile_in_tip).linear().col(2);
  }

  MotorVector lower() const { return kinematics.motorAngles(kinematics.lowerLimits()); }
  MotorVector upper() const { return kinematics.motorAngles(kinematics.upperLimits()); }

  FingerKinematics kinematics;
  Isometry3d tactile_in_tip;
};

/// Newton's method from the middle of the joint space; what it ends with may not have met.
JointVector reach(Digit& digit, const Vector3d& target, Meeting meeting) {
  MotorVector motors = 0.5 * (digit.lower() + digit.upper());
  const auto point = [&](const MotorVector& at) {
    return digit.meetingPoint(digit.kinematics.jointAngles(at), meeting);
  };
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Vector3d error = target - point(motors);
    if (error.norm() < kMet) break;
    Eigen::Matrix3d jacobian;
    for (int j = 0; j < kMotors; ++j) {
      const MotorVector step = kStep * MotorVector::Unit(j);
      jacobian.col(j) = (point(motors + step) - point(motors - step)) / (2.0 * kStep);
    }
    const MotorVector step = jacobian.fullPivLu().solve(error);
    motors += step * std::min(1.0, kLongestStep / step.norm());
  }
  return digit.kinematics.jointAngles(motors);
}

bool wellConditioned(const Configuration& found) {
  return found.within_limits && found.smallest_singular_value >= kPinchSingularValue;
}

/// The pinch with the thumb there, if the index finger can join it.
std::optional<Pinch> pinchWith(const JointVector& thumb_angles, Digit& thumb, Digit& index,
                               Meeting meeting) {
  const Configuration of_thumb = thumb.kinematics.configuration(thumb_angles);
  if (!wellConditioned(of_thumb)) return std::nullopt;
  const Vector3d target = thumb.meetingPoint(thumb_angles, meeting);
  Pinch made;
  made.thumb = thumb_angles;
  made.index = reach(index, target, meeting);
  const Configuration of_index = index.kinematics.configuration(made.index);
  made.distance = (index.meetingPoint(made.index, meeting) - target).norm();
  if (!wellConditioned(of_index) || !(made.distance <= kMet)) return std::nullopt;
  made.index_tip = index.kinematics.fingertip(made.index).translation();
  made.thumb_tip = thumb.kinematics.fingertip(made.thumb).translation();
  const double cosine = -index.padNormal(made.index).dot(thumb.padNormal(made.thumb));
  made.angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  made.smallest_singular_value =
      std::min(of_index.smallest_singular_value, of_thumb.smallest_singular_value);
  return made;
}

}  // namespace

std::optional<Pinch> findPinch(const std::string& urdf, Meeting meeting) {
  Digit index(urdf, Finger::kIndex), thumb(urdf, Finger::kThumb);
  const MotorVector span = thumb.upper() - thumb.lower();
  std::optional<Pinch> best;
  for (int i = 0; i <= kThumbSteps; ++i) {
    for (int j = 0; j <= kThumbSteps; ++j) {
      for (int k = 0; k <= kThumbSteps; ++k) {
        const MotorVector motors =
            thumb.lower() + (MotorVector(i, j, k) / kThumbSteps).cwiseProduct(span);
        const auto found = pinchWith(thumb.kinematics.jointAngles(motors), thumb, index, meeting);
        if (found && (!best || found->angle < best->angle)) best = found;
      }
    }
  }
  return best;
}

}  // namespace haptex::oracles
