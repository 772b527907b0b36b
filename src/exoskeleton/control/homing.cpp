#include "haptex/exoskeleton/control/homing.h"

#include <algorithm>
#include <cmath>

namespace haptex::exoskeleton {
namespace {

// N m s/rad: with a motor's inertia of about 2e-7 kg m^2 (links included) and velocities 10 ms old,
// a delay of 0.75 time constants, below the pi/2 of instability.
constexpr double kProportional = 1.5e-5;
// N m/rad: reaches kTorque on a stop within a second; 4 rad/s against the damping.
constexpr double kIntegral = 1e-4;
// A motor rests on its stop only if its torque has come this close to kTorque.
constexpr double kFullTorque = 0.95 * Homing::kTorque;
constexpr double kLongestPeriod = 0.01;  // s

}  // namespace

void Homing::start(const MotorVector& range, Time now) {
  status_ = Status::kRunning;
  phase_ = Phase::kApproach;
  culprit_ = -1;
  first_tick_ = true;
  range_ = range;
  integral_.setZero();
  torques_.setZero();
  start_ = last_tick_ = now;
}

void Homing::fail(Status status, int motor) {
  status_ = status;
  culprit_ = motor;
}

void Homing::enter(Phase phase, const MotorVector& angles, Time now) {
  phase_ = phase;
  still_at_ = angles;
  still_since_.fill(now);
}

MotorVector Homing::drive(double speed, const MotorVector& velocities, double dt) {
  const auto error = speed - velocities.array();
  integral_ = (integral_.array() + kIntegral * dt * error).min(kTorque).max(-kTorque);
  return (integral_.array() + kProportional * error).min(kTorque).max(-kTorque);
}

bool Homing::atRest(const MotorVector& angles, Time now) {
  bool rest = true;
  for (int i = 0; i < kMotors; ++i) {
    if (std::abs(angles[i] - still_at_[i]) > kStill || torques_[i] > -kFullTorque) {
      still_at_[i] = angles[i];
      still_since_[i] = now;
    }
    if (now - still_since_[i] < kRest) rest = false;
  }
  return rest;
}

MotorVector Homing::tick(const MotorVector& angles, const MotorVector& velocities, Time now) {
  if (status_ != Status::kRunning) return MotorVector::Zero();
  if (first_tick_) {
    first_tick_ = false;
    highest_ = angles;
    enter(Phase::kApproach, angles, now);
  }
  highest_ = highest_.cwiseMax(angles);
  const double dt = std::clamp(seconds(now - last_tick_), 0.0, kLongestPeriod);
  last_tick_ = now;

  torques_ = drive(phase_ == Phase::kLeave ? kSpeed : -kSpeed, velocities, dt);
  if (phase_ == Phase::kLeave) {
    if (((angles - stops_).array() >= kBackOff).all()) enter(Phase::kReturn, angles, now);
  } else if (atRest(angles, now)) {
    if (phase_ == Phase::kApproach) {
      stops_ = angles;
      enter(Phase::kLeave, angles, now);
    } else {
      status_ = Status::kDone;
    }
  }

  for (int i = 0; i < kMotors; ++i) {
    if (highest_[i] - angles[i] > range_[i] + kBeyondRange) {
      fail(Status::kTurnedTooFar, i);
    } else if (status_ == Status::kDone && std::abs(angles[i] - stops_[i]) > kSamePlace) {
      fail(Status::kDifferentPlace, i);
    } else if (status_ == Status::kRunning && now - start_ > kTimeout) {
      const bool leaving = phase_ == Phase::kLeave;
      const bool late = leaving ? angles[i] - stops_[i] < kBackOff : now - still_since_[i] < kRest;
      if (late) fail(leaving ? Status::kStuck : Status::kNoRest, i);
    }
    if (status_ != Status::kRunning && status_ != Status::kDone) break;
  }
  return status_ == Status::kRunning ? torques_ : MotorVector::Zero();
}

}  // namespace haptex::exoskeleton
