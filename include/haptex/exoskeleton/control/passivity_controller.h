// Takes out energy that a virtual object has no right to give.
#pragma once

#include <Eigen/Core>

namespace haptex::exoskeleton {

/// Time domain passivity observer and controller of one fingertip's port: B. Hannaford and J.-H.
/// Ryu, Time-domain passivity control of haptic interfaces, IEEE Transactions on Robotics and
/// Automation 18(1), 2002, equations 5 to 8, for three components at once.
///
/// The observer adds up the energy E that the virtual object has absorbed from the person,
/// dE = -f . v dt, of the force f that was really asked for and the measured velocity v. While E
/// stays above zero the object is passive and the controller does nothing. Where the next period
/// would take E below zero, it adds a damping force -a v with the smallest a that prevents this,
/// at most kMaxDamping and of at most the norm of f: that stops any flow of energy to the
/// person, and where there is no force there is nothing to damp.
class PassivityController {
 public:
  /// N s/m. The velocity is about 8 ms old when its force arrives (filter, line and motors), and
  /// damping a of a mass m with a delay T needs a T / m below pi/2 to be stable: with the 0.05 kg
  /// that device and fingertip have together, 2 N s/m is at 0.32, a phase margin of 72 degrees.
  static constexpr double kMaxDamping = 2.0;
  /// J. An elastic object gives back what pressing it took, 5 N against 250 N/m: 0.05 J. More is
  /// not remembered, so that long rubbing does not pay for an oscillation afterwards.
  static constexpr double kMaxCredit = 0.05;
  /// J. A moving object may do work on the person for as long as it likes; what it owes is
  /// forgotten beyond this, so that the damping ends soon (at 0.1 m/s within 0.5 s).
  static constexpr double kMaxDebt = 0.01;
  /// m/s. Slower than this is noise of the encoders, which damping would make audible.
  static constexpr double kSlowest = 0.005;

  /// Forgets the energy.
  void reset() { energy_ = 0.0; }

  /// Adds a period of dt (s, >= 0) in which `force` (N) was asked for while the fingertip moved
  /// with `velocity` (m/s). Both must be finite.
  void observe(const Eigen::Vector3d& force, const Eigen::Vector3d& velocity, double dt);

  /// The force (N) with the damping that the next period of dt (s) needs. Its damping() tells
  /// whether there was any.
  Eigen::Vector3d apply(const Eigen::Vector3d& force, const Eigen::Vector3d& velocity, double dt);

  double energy() const { return energy_; }    ///< J, absorbed by the virtual object
  double damping() const { return damping_; }  ///< N s/m, of the last apply()

 private:
  double energy_ = 0.0;
  double damping_ = 0.0;
};

}  // namespace haptex::exoskeleton
