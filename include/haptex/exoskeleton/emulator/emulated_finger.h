// The dynamics of one finger: motors, transmissions and linkage of the device, and the fingertip of
// the person who wears it.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/exoskeleton/control/fingertip_reach.h"
#include "haptex/exoskeleton/emulator/emulated_linkage.h"

namespace haptex::exoskeleton {

/// Representative values; none was measured on the HAPTEX device.
struct FingerMechanics {
  /// kg m^2, of each motor: that of a slim one, 13 mm in diameter.
  double rotor_inertia = 4e-8;
  /// N m on each motor axis: 0.01 to 0.04 N at the fingertip.
  double coulomb_friction = 6e-5;
  /// N m/rad: the elastic give of a transmission that sticks, 1.2 mrad of the motor axis.
  double presliding_stiffness = 0.05;
  /// N m s/rad on each motor axis.
  double viscous_friction = 3e-6;
  /// N m/rad and N m s/rad on each motor axis, of the stops at the limits of the joints.
  double stop_stiffness = 1.0;
  double stop_damping = 3e-4;

  /// The person's fingertip as a mass (kg) held at a place by a stiffness (N/m) and a damping
  /// (N s/m). Hajian and Howe, Identification of the mechanical impedance at the human finger tip,
  /// J. Biomech. Eng. 119 (1997), use this model; the values are representative, with a damping
  /// ratio of 1.6, and not taken from their tables.
  double fingertip_mass = 0.006;
  double fingertip_stiffness = 400.0;
  double fingertip_damping = 5.0;
  /// N s/m, of a finger that lets itself be moved.
  double relaxed_damping = 0.5;
  /// N/m and N s/m, of the pulp between thimble and fingertip: representative.
  double pulp_stiffness = 1750.0;
  double pulp_damping = 3.0;

  /// m/s^2, in hand_base, until somebody turns the hand. Acts on the device: the person carries the
  /// own finger.
  Eigen::Vector3d gravity{0.0, 0.0, -base::kStandardGravity};
};

/// In the coordinates of the three motors, to which the fourth joint is coupled. Everything is in
/// hand_base. Does not allocate after the construction.
class EmulatedFinger {
 public:
  /// How fast the person moves the place towards which the fingertip is held (m/s).
  static constexpr double kTargetSpeed = 0.5;
  /// How long the person takes from a relaxed finger back to the target (s).
  static constexpr double kReturn = 0.5;

  /// At rest in the middle of the limits.
  /// @throws std::invalid_argument as FingerKinematics and EmulatedLinkage
  EmulatedFinger(const std::string& urdf, Finger finger, const FingerMechanics& mechanics = {});

  /// Puts everything at rest at these motor angles (rad), within the limits; the person wants to
  /// stay there.
  void place(const MotorVector& motor_angles);

  /// Where the person moves the fingertip (m); one out of reach is replaced by the nearest within.
  /// @param target finite
  void setTarget(const Eigen::Vector3d& target);

  /// Whether the person lets the finger be moved.
  void relax(bool relaxed);

  /// N, what pushes the person's fingertip from outside of the device in the steps to come: zero at
  /// first.
  /// @param force finite
  void push(const Eigen::Vector3d& force) { push_ = force; }

  /// m/s^2, in hand_base, from the next step on.
  /// @param gravity finite
  void setGravity(const Eigen::Vector3d& gravity) { mechanics_.gravity = gravity; }

  /// Semi-implicit Euler: forces at the present places, but damping by the coming velocities, which
  /// then move the places.
  /// @param torques N m on the motor axes, finite
  /// @param period  s
  void step(const MotorVector& torques, double period);

  const MotorVector& motorAngles() const { return angles_; }              ///< rad
  const MotorVector& motorVelocities() const { return velocities_; }      ///< rad/s
  const Eigen::Isometry3d& thimble() const { return linkage_.tip(); }     ///< <finger>_tip (m)
  const Eigen::Vector3d& fingertip() const { return fingertip_; }         ///< m, the person's
  const Eigen::Vector3d& contactForce() const { return contact_force_; }  ///< N, on the person
  const MotorVector& lowest() const { return reach_.lowest(); }           ///< rad
  const MotorVector& highest() const { return reach_.highest(); }         ///< rad

  /// d thimble position / d motor angles (m/rad).
  const Eigen::Matrix3d& motorJacobian() const { return jacobian_; }
  /// kg m^2 on the motor axes, linkage and rotors.
  Eigen::Matrix3d massMatrix() const;
  /// N, what motor torques (N m) give at the thimble at rest; directions in which the thimble
  /// cannot move are left out.
  Eigen::Vector3d forceOf(const MotorVector& torques) const;
  /// J: kinetic, elastic and of gravity.
  double energy() const;

 private:
  void refresh();
  Eigen::Vector3d wantedPlace() const;
  MotorVector stopTorques(MotorVector& damping) const;
  void moveReference(double period);

  FingerMechanics mechanics_;
  EmulatedLinkage linkage_;
  FingerKinematics kinematics_;
  FingertipReach reach_;
  Eigen::Matrix<double, kJoints, kMotors> coupling_;  // d joint angles / d motor angles

  MotorVector angles_, velocities_;  // rad, rad/s
  MotorVector presliding_;           // rad, by which each transmission gives while it sticks
  Eigen::Vector3d fingertip_, fingertip_velocity_;
  Eigen::Matrix3d jacobian_;
  Eigen::Vector3d contact_force_;
  Eigen::Vector3d push_ = Eigen::Vector3d::Zero();  // N

  FingertipReach::Place target_;
  Eigen::Vector3d asked_target_;
  Eigen::Vector3d reference_;  // follows the target at kTargetSpeed
  Eigen::Vector3d return_from_;
  double returned_ = 1.0;  // share of the way back from a relaxed finger, in time
  bool relaxed_ = false;
};

}  // namespace haptex::exoskeleton
