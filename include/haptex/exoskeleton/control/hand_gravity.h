// Gravity as a turning hand sees it, for as long as somebody says how the hand is turned.
#pragma once

#include <Eigen/Core>

#include "haptex/base/constants.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// m/s^2, in hand_base. @param rotation of hand_base in world, whose z is up
inline Eigen::Vector3d gravityIn(const Eigen::Matrix3d& rotation) {
  return -base::kStandardGravity * rotation.row(2).transpose();
}

/// Follows what it is told, and goes to zero, which stands for not known, when it is told nothing:
/// a weight that is held in a wrong direction is worse than one that is not held. Not thread-safe,
/// does not allocate.
class HandGravity {
 public:
  /// An orientation that is older than this is not known any more.
  static constexpr Time kTimeout = std::chrono::milliseconds(500);
  /// s, from full gravity to none or back. A hand that turns at 10 rad/s is followed.
  static constexpr double kFade = 0.1;

  /// Dropped if it is not finite or more than twice standard gravity: of a hand, that is wrong.
  /// @param gravity m/s^2, in hand_base @param at when the hand was turned so
  void receive(const Eigen::Vector3d& gravity, Time at);

  /// Once per period. @returns value()
  const Eigen::Vector3d& tick(Time now);

  /// m/s^2, in hand_base; zero where it is not known.
  const Eigen::Vector3d& value() const { return value_; }

 private:
  Eigen::Vector3d told_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  Time told_at_{0};
  Time last_tick_{0};
  bool has_been_told_ = false;
};

}  // namespace haptex::exoskeleton
