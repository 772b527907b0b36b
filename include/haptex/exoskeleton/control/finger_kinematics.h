// Kinematics of one finger of the exoskeleton between motors, joints and fingertip.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// Revolutions of a motor per revolution of its joint. Magnenat-Thalmann et al., From physics-based
/// simulation to the touching of textiles: the HAPTEX project, section V.
constexpr double kReduction = 14.0;

/// How a configuration stands to the limits of the mechanism.
struct Configuration {
  bool within_limits = true;
  int outside = -1;  ///< first joint outside of its limits, or -1
  /// Smallest singular value of the Jacobian with respect to the driven joints (m/rad). Along its
  /// direction an error of the joint torque is felt as a force error 1/this as large, and the
  /// joints turn 1/this as fast as the fingertip moves.
  double smallest_singular_value = 0.0;
  bool singular = false;  ///< that is below kSingular
};

/// Below this singular value (m/rad) a configuration counts as singular: 2 mN m of friction in the
/// joints (representative) are felt as more than 0.5 N, a tenth of the largest force.
constexpr double kSingular = 0.004;

/// Built from the URDF: the chain from hand_base to <finger>_tip, whose last joint mimics the one
/// before it. Not thread-safe; allocates in the constructor only.
class FingerKinematics {
 public:
  /// @param urdf the text of a URDF
  /// @throws std::invalid_argument naming the finger and what is wrong: a text that urdfdom cannot
  ///   read (a revolute joint without limits or a number that is not finite, too); no link
  ///   hand_base or <finger>_tip, or the one does not descend from the other; a joint between them
  ///   that is neither revolute nor fixed, has limits that do not increase or an axis without
  ///   direction; another number of revolute joints than four; the last does not mimic the one
  ///   before it; a link behind one of them with a mass below zero
  FingerKinematics(const std::string& urdf, Finger finger);
  ~FingerKinematics();
  FingerKinematics(FingerKinematics&&) noexcept;
  FingerKinematics& operator=(FingerKinematics&&) noexcept;

  /// From the palm to the tip.
  const std::array<std::string, kJoints>& jointNames() const;
  const JointVector& lowerLimits() const;  ///< rad
  const JointVector& upperLimits() const;  ///< rad

  /// rad; the last joint follows the one before it as its mimic says.
  JointVector jointAngles(const MotorVector& motor_angles) const;
  /// rad; ignores the last joint.
  MotorVector motorAngles(const JointVector& joint_angles) const;

  /// Pose of <finger>_tip in hand_base (m).
  Eigen::Isometry3d fingertip(const JointVector& joint_angles);
  /// d fingertip position / d motor angles (m/rad, 3x3, in hand_base), coupling and reduction
  /// included. Its transpose takes a force (N) to motor torques (N m).
  Eigen::Matrix3d motorJacobian(const JointVector& joint_angles);
  /// Times gravity (m/s^2, in hand_base): the motor torques (N m) that hold the links at rest,
  /// those of the coupled joint included; in kg m. The masses are those of the URDF, with what is
  /// fixed to each link; links without inertials weigh nothing.
  Eigen::Matrix3d motorWeight(const JointVector& joint_angles);

  /// An angle that is not a number is outside of its limits, and singular.
  Configuration configuration(const JointVector& joint_angles);

 private:
  struct Chain;
  std::unique_ptr<Chain> chain_;
};

}  // namespace haptex::exoskeleton
