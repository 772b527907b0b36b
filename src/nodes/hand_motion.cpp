#include "haptex/nodes/hand_motion.h"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace haptex::nodes {
namespace {

using exoskeleton::Finger;

void requireNear(const Eigen::Vector3d& position, const char* what) {
  // Not by the norm, whose square overflows first.
  if (position.allFinite() && position.cwiseAbs().maxCoeff() <= HandMotion::kFarthest) return;
  std::ostringstream message;
  message << what << " = (" << position.transpose() << "): allowed are finite coordinates from "
          << -HandMotion::kFarthest << " to " << HandMotion::kFarthest << " m";
  throw std::invalid_argument(message.str());
}

}  // namespace

HandMotion::HandMotion(exoskeleton::HandPath path) : path_(std::move(path)) {}

exoskeleton::HandPlace HandMotion::at(exoskeleton::Time now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!start_) start_ = now;
  exoskeleton::HandPlace place = path_.at(exoskeleton::seconds(now - *start_));
  for (const Finger finger : exoskeleton::kFingers) {
    if (targets_[finger]) place.fingertips[finger] = *targets_[finger];
  }
  if (hand_base_) place.hand_base = *hand_base_;
  return place;
}

void HandMotion::take(Finger finger, const Eigen::Vector3d& target) {
  requireNear(target, "target");
  const std::lock_guard<std::mutex> lock(mutex_);
  targets_[finger] = target;
}

void HandMotion::take(const Eigen::Isometry3d& hand_base) {
  requireNear(hand_base.translation(), "position of hand_base");
  if (!hand_base.linear().allFinite()) {
    throw std::invalid_argument("orientation of hand_base: allowed are finite numbers");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  hand_base_ = hand_base;
}

}  // namespace haptex::nodes
