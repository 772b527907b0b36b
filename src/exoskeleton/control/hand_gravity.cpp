#include "haptex/exoskeleton/control/hand_gravity.h"

#include <algorithm>

namespace haptex::exoskeleton {

using Eigen::Vector3d;

void HandGravity::receive(const Vector3d& gravity, Time at) {
  if (!gravity.allFinite() || gravity.norm() > 2.0 * base::kStandardGravity) return;
  told_ = gravity;
  told_at_ = at;
  has_been_told_ = true;
}

const Vector3d& HandGravity::tick(Time now) {
  const bool known = has_been_told_ && now - told_at_ <= kTimeout;
  const Vector3d change = (known ? told_ : Vector3d::Zero()) - value_;
  const double most =
      base::kStandardGravity / kFade * std::clamp(seconds(now - last_tick_), 0.0, kFade);
  const double size = change.norm();
  value_ += size <= most ? change : Vector3d(change * (most / size));
  last_tick_ = now;
  return value_;
}

}  // namespace haptex::exoskeleton
