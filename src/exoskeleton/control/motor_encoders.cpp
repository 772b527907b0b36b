#include "haptex/exoskeleton/control/motor_encoders.h"

#include <cmath>

namespace haptex::exoskeleton {
namespace {

constexpr double kRadiansPerCount = 2.0 * M_PI / kCountsPerRevolution;

// Unsigned, because signed overflow is undefined; right across the wrap-around.
std::int32_t difference(std::int32_t after, std::int32_t before) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(after) -
                                   static_cast<std::uint32_t>(before));
}

}  // namespace

bool MotorEncoders::update(const std::array<std::int32_t, kMotors>& counts, double dt) {
  if (!has_counts_) {
    counts_ = counts;
    has_counts_ = true;
    return true;
  }
  if (!(dt > 0.0)) return true;
  MotorVector moved;
  for (int i = 0; i < kMotors; ++i) {
    moved[i] = kRadiansPerCount * difference(counts[i], counts_[i]);
    if (std::abs(moved[i]) > kMaxSpeed * dt) return false;
  }
  // Whole counts are added up, because sums of angles would drift by their rounding.
  for (int i = 0; i < kMotors; ++i) {
    since_calibrated_[i] += difference(counts[i], counts_[i]);
    angles_[i] = calibrated_at_[i] + kRadiansPerCount * static_cast<double>(since_calibrated_[i]);
  }
  counts_ = counts;
  const double share = -std::expm1(-2.0 * M_PI * kVelocityBandwidth * dt);
  half_filtered_ += share * (moved / dt - half_filtered_);
  velocities_ += share * (half_filtered_ - velocities_);
  return true;
}

void MotorEncoders::calibrate(const MotorVector& angles) {
  calibrated_at_ = angles_ = angles;
  since_calibrated_.fill(0);
}

void MotorEncoders::restart() {
  has_counts_ = false;
  half_filtered_.setZero();
  velocities_.setZero();
}

}  // namespace haptex::exoskeleton
