#include "haptex/exoskeleton/control/smooth_command.h"

#include <cmath>

#include "haptex/exoskeleton/control/safety_chain.h"

namespace haptex::exoskeleton {
namespace {

using Eigen::Vector3d;

const double kLeft = std::exp(-SmoothCommand::kPeriod / SmoothCommand::kSmoothing);

}  // namespace

Vector3d SmoothCommand::value(const Vector3d& p, const Vector3d& v) const {
  const Vector3d force = evaluate(command_, p, v);
  return force.allFinite() ? haptex::exoskeleton::saturated(force, kMaxForce) : force;
}

void SmoothCommand::receive(const ForceCommand& command, const Vector3d& p, const Vector3d& v) {
  const Vector3d before = value(p, v);
  command_ = command;
  if (resting_) return;
  const Vector3d change = value(p, v) - before;
  if (!change.allFinite()) return;
  half_faded_ += change;
  difference_ += change;
}

void SmoothCommand::receiveFrom(const Vector3d& rendered, const ForceCommand& command,
                                const Vector3d& p, const Vector3d& v) {
  command_ = command;
  const Vector3d force = value(p, v);
  resting_ = !force.allFinite();
  if (!resting_) half_faded_ = difference_ = force - rendered;
}

void SmoothCommand::rest() {
  resting_ = true;
  saturated_ = false;
  half_faded_.setZero();
  difference_.setZero();
}

Vector3d SmoothCommand::tick(const Vector3d& p, const Vector3d& v) {
  const Vector3d force = value(p, v);
  if (!force.allFinite()) {
    rest();
    return force;
  }
  if (resting_) {
    resting_ = false;
    half_faded_ = difference_ = force;
  }
  saturated_ = force != evaluate(command_, p, v);
  half_faded_ *= kLeft;
  difference_ = kLeft * difference_ + (1.0 - kLeft) * half_faded_;
  return force - difference_;
}

}  // namespace haptex::exoskeleton
