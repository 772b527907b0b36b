#include "haptex/exoskeleton/control/passivity_controller.h"

#include <algorithm>
#include <cmath>

namespace haptex::exoskeleton {

using Eigen::Vector3d;

void PassivityController::observe(const Vector3d& force, const Vector3d& velocity, double dt) {
  energy_ = std::clamp(energy_ - force.dot(velocity) * dt, -kMaxDebt, kMaxCredit);
}

Vector3d PassivityController::apply(const Vector3d& force, const Vector3d& velocity, double dt) {
  damping_ = 0.0;
  const double speed_squared = velocity.squaredNorm();
  if (dt <= 0.0 || speed_squared < kSlowest * kSlowest) return force;
  const double next = energy_ - force.dot(velocity) * dt;
  if (next >= 0.0) return force;
  const double most = std::min(kMaxDamping, force.norm() / std::sqrt(speed_squared));
  damping_ = std::min(-next / (speed_squared * dt), most);
  return force - damping_ * velocity;
}

}  // namespace haptex::exoskeleton
