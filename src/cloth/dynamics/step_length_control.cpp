#include "haptex/cloth/dynamics/step_length_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/base/require.h"

namespace haptex::cloth {
namespace {

using Eigen::Vector3d;

constexpr double kSafety = 0.9;
constexpr double kMostGrowth = 2.0, kLeastGrowth = 0.2;
constexpr double kRounding = 1e-9;  // relative, of lengths

int orderOf(IntegrationMethod method) {
  switch (method) {
    case IntegrationMethod::kBackwardEuler:
    case IntegrationMethod::kExplicitEuler:
    case IntegrationMethod::kTwoStepEuler:
      return 1;
    default:
      return 2;  // as far as the estimate tells
  }
}

}  // namespace

StepLengthControl::StepLengthControl(const Cloth& cloth, IntegrationMethod method,
                                     const AdaptiveSteps& steps)
    : steps_(steps),
      order_(orderOf(method)),
      next_(steps.shortest),
      before_(cloth.particleCount(), Vector3d::Zero()) {
  if (!std::isfinite(steps.shortest) || steps.shortest <= 0.0) {
    base::refuse("the shortest step is ", steps.shortest, " s; it must be finite and > 0");
  }
  if (!std::isfinite(steps.longest) || steps.longest < steps.shortest) {
    base::refuse("the longest step is ", steps.longest,
                 " s; it must be finite and >= ", steps.shortest, " s, the shortest");
  }
  if (!std::isfinite(steps.error) || steps.error <= 0.0) {
    base::refuse("the error of a step is ", steps.error, " m; it must be finite and > 0");
  }
}

double StepLengthControl::lengthWithin(double left) const {
  const double most = std::floor(left / steps_.shortest * (1.0 + kRounding));
  const double wanted = std::ceil(left / next_ * (1.0 - kRounding));
  return left / std::max(1.0, std::min(most, wanted));
}

bool StepLengthControl::judge(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                              double left) {
  const double length = lengthWithin(left);
  if (begin.time != taken_until_) before_length_ = 0.0;  // it goes on from somewhere else
  error_ = estimate(cloth, begin, end, length);
  // What the first step of a method of order 2 misses cannot be told.
  const bool known = order_ == 1 || before_length_ > 0.0;
  if (!known) error_ = 0.0;
  const double ratio =
      error_ > 0.0 ? std::pow(kSafety * steps_.error / error_, 1.0 / (order_ + 1)) : kMostGrowth;
  next_ = std::clamp(length * std::clamp(ratio, kLeastGrowth, kMostGrowth), steps_.shortest,
                     steps_.longest);
  if (missed() && lengthWithin(left) < length) return false;
  before_length_ = length;
  taken_until_ = end.time;
  std::copy(begin.velocities.begin(), begin.velocities.end(), before_.begin());
  return true;
}

bool StepLengthControl::shorten(double left) {
  const double length = lengthWithin(left);
  next_ = std::max(steps_.shortest, kLeastGrowth * length);
  return lengthWithin(left) < length;
}

double StepLengthControl::estimate(const Cloth& cloth, const ClothState& begin,
                                   const ClothState& end, double length) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (cloth.attachments()[i]) continue;
    const Vector3d change = end.velocities[i] - begin.velocities[i];
    Vector3d missed = end.positions[i] - begin.positions[i] -
                      0.5 * length * (begin.velocities[i] + end.velocities[i]);
    if (before_length_ > 0.0) {
      const Vector3d before = (begin.velocities[i] - before_[i]) / before_length_;
      missed +=
          length * length * length / (6.0 * (length + before_length_)) * (change / length - before);
    }
    const double squared = missed.squaredNorm();
    if (!std::isfinite(squared)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, squared);
  }
  return std::sqrt(largest);
}

}  // namespace haptex::cloth
