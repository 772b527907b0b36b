#include "haptex/exoskeleton/emulator/emulated_device.h"

#include <cmath>

#include "haptex/exoskeleton/control/hand_gravity.h"

namespace haptex::exoskeleton {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kCountsPerRadian = kCountsPerRevolution / (2.0 * kPi);
constexpr std::uint64_t kMicrosecondsPerStep = 125;
static_assert(kMicrosecondsPerStep * EmulatedDevice::kRate == 1e6);

/// N, at a time (s) of the device.
double shake(double time) {
  return EmulatedDevice::kSlowVibration * std::sin(2.0 * kPi * 40.0 * time) +
         EmulatedDevice::kFastVibration * std::sin(2.0 * kPi * 320.0 * time);
}

}  // namespace

EmulatedDevice::EmulatedDevice(const std::string& urdf, unsigned seed,
                               const FingerMechanics& mechanics)
    : fingers_{{EmulatedSide(urdf, Finger::kIndex, mechanics),
                EmulatedSide(urdf, Finger::kThumb, mechanics)}},
      generator_(seed) {
  // Nobody knows where the fingers are when the device is switched on.
  std::uniform_real_distribution<double> share(0.4, 0.6);
  for (EmulatedSide& side : fingers_.values) {
    const MotorVector lowest = side.dynamics.lowest(), highest = side.dynamics.highest();
    for (int i = 0; i < kMotors; ++i) {
      side.switched_on_at[i] = lowest[i] + share(generator_) * (highest[i] - lowest[i]);
    }
    side.dynamics.place(side.switched_on_at);
    side.updateTruth(MotorVector::Zero());
  }
}

void EmulatedDevice::setTarget(Finger finger, const Vector3d& target) {
  if (target.allFinite()) fingers_[finger].dynamics.setTarget(target);
}

void EmulatedDevice::turnHand(const Eigen::Matrix3d& rotation) {
  if (!rotation.allFinite()) return;
  const Vector3d gravity = gravityIn(rotation);
  for (EmulatedSide& side : fingers_.values) side.dynamics.setGravity(gravity);
}

void EmulatedDevice::keepApart() {
  EmulatedFinger& index = fingers_[Finger::kIndex].dynamics;
  EmulatedFinger& thumb = fingers_[Finger::kThumb].dynamics;
  const Vector3d way = index.fingertip() - thumb.fingertip();
  const double distance = way.norm();
  const bool meet = distance > 0.0 && distance < kClosest;
  const Vector3d force =
      meet ? Vector3d(kBoneStiffness * (kClosest / distance - 1.0) * way) : Vector3d::Zero();
  index.push(force);
  thumb.push(-force);
}

void EmulatedDevice::step(const DeviceCommand& command) {
  ++steps_;
  keepApart();
  for (const Finger finger : kFingers) {
    EmulatedSide& side = fingers_[finger];
    MotorVector torques = command.torques[finger];
    if (command.mode == DriveMode::kOff || !torques.allFinite()) torques.setZero();
    torques = torques.cwiseMax(-kMaxTorque).cwiseMin(kMaxTorque);
    side.dynamics.relax(command.mode == DriveMode::kHoming);
    side.dynamics.step(torques, 1.0 / kRate);
    side.updateTruth(torques);
  }
}

void EmulatedDevice::EmulatedSide::updateTruth(const MotorVector& torques) {
  truth.motor_angles = dynamics.motorAngles();
  truth.position = dynamics.thimble().translation();
  truth.contact_force = dynamics.contactForce();
  truth.motor_force = dynamics.forceOf(torques);
}

DeviceState EmulatedDevice::read() {
  DeviceState state;
  state.time = static_cast<std::uint32_t>(kMicrosecondsPerStep * steps_);  // wraps around
  for (const Finger finger : kFingers) state.fingers[finger] = reading(fingers_[finger]);
  return state;
}

FingerReading EmulatedDevice::reading(const EmulatedSide& side) {
  FingerReading reading;
  const MotorVector turned = side.dynamics.motorAngles() - side.switched_on_at;
  for (int i = 0; i < kMotors; ++i) {
    reading.encoder_counts[i] =
        static_cast<std::int32_t>(std::lround(turned[i] * kCountsPerRadian));
  }
  const Vector3d force = side.dynamics.thimble().linear().transpose() * side.truth.contact_force;
  for (int i = 0; i < 3; ++i) {
    double measured = force[i] + noise_(generator_);
    if (sensors_shaken_ && i == 2) measured += shake(static_cast<double>(steps_) / kRate);
    if (side.sensor_saturated && i == 2) measured = kForceRange;
    if (std::abs(measured) >= kForceRange) {
      measured = std::copysign(kForceRange, measured);
      reading.force_saturated = true;
    }
    reading.force[i] = kForceStep * std::round(measured / kForceStep);
  }
  return reading;
}

void EmulatedDevice::saturateSensor(Finger finger, bool saturated) {
  fingers_[finger].sensor_saturated = saturated;
}

}  // namespace haptex::exoskeleton
