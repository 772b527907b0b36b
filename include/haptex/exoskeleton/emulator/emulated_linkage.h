// Masses and geometry of one finger of the emulated exoskeleton: mass matrix, bias torques and
// Jacobian of its linkage in joint coordinates.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

using JointMatrix = Eigen::Matrix<double, kJoints, kJoints>;
using TipJacobian = Eigen::Matrix<double, 3, kJoints>;

/// Four revolute joints with a rigid body behind each, in hand_base. What is fixed to a link, for
/// example its part of the remote-centre mechanism, belongs to its body. The coupling of the last
/// joint is not known here. Allocates in the constructor only.
class EmulatedLinkage {
 public:
  /// @param urdf text of the exoskeleton's URDF
  /// @throws std::invalid_argument naming the finger and what its chain from hand_base to
  ///   <finger>_tip lacks: four revolute joints, or a positive mass behind each
  EmulatedLinkage(const std::string& urdf, Finger finger);

  /// Everything below holds for the joint angles (rad) given here; zero after the construction.
  void setAngles(const JointVector& joint_angles);

  /// Pose of <finger>_tip (m).
  const Eigen::Isometry3d& tip() const { return tip_; }
  /// d position of <finger>_tip / d joint angles, each on its own (m/rad).
  TipJacobian tipJacobian() const;

  /// kg m^2, by the composite rigid bodies behind each joint: Featherstone, Rigid Body Dynamics
  /// Algorithms (2008), chapter 6.
  JointMatrix massMatrix() const;

  /// N m, Coriolis and centrifugal torques and those that hold the linkage against gravity, by the
  /// recursive Newton-Euler algorithm: Featherstone, chapter 5.
  /// @param velocities rad/s
  /// @param gravity    m/s^2
  JointVector biasTorques(const JointVector& velocities, const Eigen::Vector3d& gravity) const;

  /// J, of the masses under gravity (m/s^2), zero at the origin of hand_base.
  double potentialEnergy(const Eigen::Vector3d& gravity) const;

 private:
  struct Body {
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  // of the joint in the body before it
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();           // of the joint, in the body's frame
    double mass = 0.0;                                         // kg
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();          // m, of mass, in the body's frame
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();         // kg m^2, about the centre of mass
  };
  // The same in hand_base at the present angles.
  struct Placed {
    Eigen::Vector3d axis, joint, centre;
    Eigen::Matrix3d inertia;
  };

  std::array<Body, kJoints> bodies_;
  std::array<Placed, kJoints> placed_;
  Eigen::Isometry3d tip_in_last_body_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d tip_ = Eigen::Isometry3d::Identity();
};

}  // namespace haptex::exoskeleton
