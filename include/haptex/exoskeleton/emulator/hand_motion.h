// Where the emulated person's hand is and where the fingers want to be: as a path says, until
// somebody else does. Knows no ROS and reads no clock.
#pragma once

#include <Eigen/Geometry>
#include <mutex>
#include <optional>

#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// at() is for one thread, which does not wait for the others: receive() may be called from any.
class HandMotion {
 public:
  /// Largest coordinate that is taken (m): no hand is further away.
  static constexpr double kFarthest = 10.0;

  /// @param path starts at the first call of at()
  explicit HandMotion(HandPath path);

  HandPlace at(Time now);
  const HandPath& path() const { return path_; }

  /// From now on the fingertip wants to be there (m, in hand_base), or the hand is there (pose of
  /// hand_base in world), whatever the path says.
  /// @throws std::invalid_argument naming the value and what is allowed if it is not finite or
  ///   beyond kFarthest; nothing has changed then
  void receive(Finger finger, const Eigen::Vector3d& target);
  void receive(const Eigen::Isometry3d& hand_base);

 private:
  struct Taken {
    PerFinger<std::optional<Eigen::Vector3d>> targets;
    std::optional<Eigen::Isometry3d> hand_base;
  };

  const HandPath path_;
  // Of the thread of at().
  std::optional<Time> start_;
  Taken known_;

  std::mutex mutex_;  // guards the next
  Taken taken_;
};

}  // namespace haptex::exoskeleton
