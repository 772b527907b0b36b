#include "haptex/exoskeleton/emulator/hand_motion.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::exoskeleton {
namespace {

void requireNear(const Eigen::Vector3d& position, const char* what) {
  // Not by the norm, whose square overflows first.
  if (position.allFinite() && position.cwiseAbs().maxCoeff() <= HandMotion::kFarthest) return;
  std::ostringstream message;
  message << what << " = (" << position.transpose() << "): allowed are finite coordinates from "
          << -HandMotion::kFarthest << " to " << HandMotion::kFarthest << " m";
  throw std::invalid_argument(message.str());
}

}  // namespace

HandMotion::HandMotion(HandPath path) : path_(std::move(path)) {}

HandPlace HandMotion::at(Time now) {
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (lock.owns_lock()) known_ = taken_;  // else the next time
  }
  if (!start_) start_ = now;
  HandPlace place = path_.at(seconds(now - *start_));
  for (const Finger finger : kFingers) {
    if (known_.targets[finger]) place.fingertips[finger] = *known_.targets[finger];
  }
  if (known_.hand_base) place.hand_base = *known_.hand_base;
  return place;
}

void HandMotion::receive(Finger finger, const Eigen::Vector3d& target) {
  requireNear(target, "target");
  const std::lock_guard<std::mutex> lock(mutex_);
  taken_.targets[finger] = target;
}

void HandMotion::receive(const Eigen::Isometry3d& hand_base) {
  requireNear(hand_base.translation(), "position of hand_base");
  if (!hand_base.linear().allFinite()) {
    throw std::invalid_argument("orientation of hand_base: allowed are finite numbers");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  taken_.hand_base = hand_base;
}

}  // namespace haptex::exoskeleton
