#include "haptex/exoskeleton/control/force_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {
namespace {

using Eigen::Vector3d;

// N m, what 16 bits say.
constexpr double kEncodable = std::numeric_limits<std::int16_t>::max() * kTorqueStep;

// Share of the way that a filter of first order goes in a period.
double share(double time_constant) {
  return -std::expm1(-ForceController::kPeriod / time_constant);
}

const double kResponseShare = share(ForceController::kResponse);
const double kSlowShare = share(ForceController::kSlow);
const double kErrorShare = share(ForceController::kErrorFilter);
constexpr double kFadeStep = ForceController::kPeriod / ForceController::kFade;
constexpr double kReleaseStep = ForceController::kPeriod / ForceController::kRelease;

void filter(const Vector3d& in, double share_of_way, Vector3d& first, Vector3d& second) {
  first += share_of_way * (in - first);
  second += share_of_way * (first - second);
}

}  // namespace

void ForceController::reset() {
  for (Vector3d* vector : {&half_expected_, &expected_, &half_slow_, &slow_, &force_, &error_,
                           &integral_, &correction_}) {
    vector->setZero();
  }
  on_its_way_.fill(Vector3d::Zero());
  oldest_ = 0;
  share_ = release_left_ = 1.0;
  weight_share_ = 0.0;
  torque_limited_ = false;
  released_ = true;
}

void ForceController::expect(const ForceInput& input) {
  filter(on_its_way_[oldest_], kResponseShare, half_expected_, expected_);
  on_its_way_[oldest_] = input.desired;
  oldest_ = (oldest_ + 1) % kLatency;
  filter(expected_, kSlowShare, half_slow_, slow_);
}

void ForceController::integrate(const Vector3d& desired, const Vector3d& measured) {
  error_ += kErrorShare * (expected_ - measured - error_);
  const double change = (desired - slow_).norm();
  const Vector3d next = saturated(
      integral_ + kIntegral * kPeriod / (1.0 + change / kLargeChange) * error_, kMaxCorrection);
  // The torques are at their limit: more of the same would only have to be undone later.
  if (torque_limited_ && next.norm() > integral_.norm()) return;
  integral_ = next;
}

MotorVector ForceController::torques(const ForceInput& input) {
  force_ = slewLimited(input.desired + correction_, force_, kPeriod);
  MotorVector torques =
      input.jacobian.transpose() * force_ +
      release_left_ * (weight_share_ * input.weight - kDamping * input.motor_velocities);
  torque_limited_ = false;
  for (int i = 0; i < kMotors; ++i) {
    const double needed = (kMaxForce + kMaxCorrection) * input.jacobian.col(i).norm();
    const double limit = std::min(needed, kEncodable);
    if (std::abs(torques[i]) <= limit) continue;
    torque_limited_ = true;
    torques[i] = std::isfinite(torques[i]) ? std::copysign(limit, torques[i]) : 0.0;
  }
  return torques;
}

MotorVector ForceController::tick(const ForceInput& input) {
  released_ = false;
  share_ *= release_left_;  // enabled again before the release was through
  weight_share_ *= release_left_;
  release_left_ = 1.0;
  expect(input);
  const bool sensor_works = input.sensor_works && input.measured.allFinite();
  const bool feedback = sensor_works && input.obeyed;
  if (!sensor_works) ++feed_forward_only_;
  if (!feedback) {
    error_.setZero();
  } else if (input.measured_now) {
    integrate(input.desired, input.measured);
  }
  share_ = std::clamp(share_ + (feedback ? kFadeStep : -kFadeStep), 0.0, 1.0);
  weight_share_ = std::clamp(weight_share_ + (input.obeyed ? kFadeStep : -kFadeStep), 0.0, 1.0);
  correction_ = share_ * saturated(integral_ + kProportional * error_, kMaxCorrection);
  return torques(input);
}

MotorVector ForceController::release(const ForceInput& input) {
  if (released_) return MotorVector::Zero();
  const double left = release_left_;
  release_left_ = std::max(0.0, release_left_ - kReleaseStep);
  correction_ *= left > 0.0 ? release_left_ / left : 0.0;
  const MotorVector last = torques(input);
  if (release_left_ == 0.0 && force_.isZero(0.0)) {
    reset();
    return MotorVector::Zero();
  }
  return last;
}

}  // namespace haptex::exoskeleton
