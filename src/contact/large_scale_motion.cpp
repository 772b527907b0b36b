#include "haptex/contact/large_scale_motion.h"

#include <algorithm>

namespace haptex::contact {

LargeScaleMotion::LargeScaleMotion(std::size_t particles)
    : start_(particles, Eigen::Vector3d::Zero()), target_(particles, Eigen::Vector3d::Zero()) {}

void LargeScaleMotion::receive(const std::vector<Eigen::Vector3d>& positions, double period,
                               double time) {
  if (has_state_) {
    for (std::size_t i = 0; i < start_.size(); ++i) start_[i] = position(static_cast<int>(i));
    progress_ = 0.0;
  } else {
    std::copy(positions.begin(), positions.end(), start_.begin());
    progress_ = 1.0;
  }
  std::copy(positions.begin(), positions.end(), target_.begin());
  period_ = period;
  time_ = time;
  has_state_ = true;
}

void LargeScaleMotion::advance(double seconds) {
  progress_ = std::min(1.0, progress_ + seconds / period_);
}

}  // namespace haptex::contact
