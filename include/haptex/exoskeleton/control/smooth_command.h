// Takes the jumps out of a stream of force commands.
#pragma once

#include <Eigen/Core>

#include "haptex/exoskeleton/control/force_command.h"

namespace haptex::exoskeleton {

/// A step of the force would make device, pulp and finger ring at 30 to 70 Hz. So where one command
/// follows another, the difference of their forces at the present place and velocity fades within a
/// few kSmoothing, as the step response of two low-pass filters. What a command says of place and
/// velocity is not filtered: a late spring gives energy. Commands that describe the same object do
/// not differ, and are followed at once.
///
/// Does not allocate.
class SmoothCommand {
 public:
  /// s, of each of the two filters.
  static constexpr double kSmoothing = 0.004;
  static constexpr double kPeriod = 0.001;  ///< s, of tick()

  /// @param p, v place (m) and velocity (m/s) now
  void receive(const ForceCommand& command, const Eigen::Vector3d& p, const Eigen::Vector3d& v);

  /// The same, where this force (N) is rendered now, less than the command before asked for: goes
  /// on from there.
  void receiveFrom(const Eigen::Vector3d& rendered, const ForceCommand& command,
                   const Eigen::Vector3d& p, const Eigen::Vector3d& v);

  /// No force; the next tick() begins from there.
  void rest();

  /// One period. @returns N, of at most kMaxForce before the differences are taken off; not
  ///   finite if the command is not at this place and velocity
  Eigen::Vector3d tick(const Eigen::Vector3d& p, const Eigen::Vector3d& v);

  /// The last tick() had to shorten the force of the command.
  bool saturated() const { return saturated_; }

 private:
  Eigen::Vector3d value(const Eigen::Vector3d& p, const Eigen::Vector3d& v) const;

  ForceCommand command_;
  Eigen::Vector3d half_faded_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d difference_ = Eigen::Vector3d::Zero();  // N, what is still to come
  bool resting_ = true;
  bool saturated_ = false;
};

}  // namespace haptex::exoskeleton
