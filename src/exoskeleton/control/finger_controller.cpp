#include "haptex/exoskeleton/control/finger_controller.h"

namespace haptex::exoskeleton {

using Eigen::Vector3d;

const char* describe(NoForceReason reason) {
  switch (reason) {
    case NoForceReason::kNone:
      return "nothing stands in the way of a force";
    case NoForceReason::kNoDevice:
      return "the device does not answer";
    case NoForceReason::kFault:
      return "a fault is latched";
    case NoForceReason::kHoming:
      return "the device is homing";
    case NoForceReason::kNotHomed:
      return "the encoders are not calibrated: home the device";
    case NoForceReason::kDisabled:
      return "the device is disabled";
    case NoForceReason::kPaused:
      return "the device is paused";
    case NoForceReason::kNoCommand:
      return "nobody commands a force";
    case NoForceReason::kOutsideLimits:
      return "a joint is outside of its limits";
    case NoForceReason::kSingular:
      return "the finger is so straight that forces along it cannot be rendered";
  }
  return "";
}

FingerController::FingerController(const std::string& urdf, Finger finger)
    : kinematics_(urdf, finger),
      lower_stops_(kinematics_.motorAngles(kinematics_.lowerLimits())),
      coupling_offset_(kinematics_.jointAngles(MotorVector::Zero())) {
  encoders_.calibrate(lower_stops_);
  updatePose();
}

void FingerController::updatePose() {
  FingerMeasurement& m = measurement_;
  m.joint_angles = kinematics_.jointAngles(encoders_.angles());
  m.joint_velocities = kinematics_.jointAngles(encoders_.velocities()) - coupling_offset_;
  m.pose = kinematics_.fingertip(m.joint_angles);
  jacobian_ = kinematics_.motorJacobian(m.joint_angles);
  m.velocity = jacobian_ * encoders_.velocities();

  const auto below = kinematics_.lowerLimits() - m.joint_angles;
  const auto above = m.joint_angles - kinematics_.upperLimits();
  const double tolerated = outside_limits_ ? 0.0 : kLimitTolerance;
  outside_limits_ = !(below.cwiseMax(above).maxCoeff() <= tolerated);
  const Configuration configuration = kinematics_.configuration(m.joint_angles);
  const double edge = singular_ ? kLeaveSingular * kSingular : kSingular;
  singular_ = configuration.singular || configuration.smallest_singular_value < edge;
}

bool FingerController::measure(const FingerReading& reading, double dt) {
  const bool plausible = encoders_.update(reading.encoder_counts, dt);
  updatePose();
  const bool finite = reading.force.allFinite();
  if (finite) {
    measurement_.force = measurement_.pose.linear() * reading.force;
  } else {
    chain_.countNotFinite();
  }
  sensor_works_ = finite && !reading.force_saturated;
  measured_now_ = true;
  return plausible;
}

void FingerController::command(const ForceCommand& command, bool obeyed, Time now) {
  if (!isFinite(command)) {
    chain_.countNotFinite();
    return;
  }
  if (!obeyed) return;
  const Vector3d& p = measurement_.pose.translation();
  if (has_command_ && chain_.commandsStopped()) {
    command_.receiveFrom(chain_.force(), command, p, measurement_.velocity);
  } else {
    command_.receive(command, p, measurement_.velocity);
  }
  has_command_ = true;
  chain_.commandAccepted(now);
}

void FingerController::startHoming(Time now) {
  homing_.start(kinematics_.motorAngles(kinematics_.upperLimits()) - lower_stops_, now);
}

MotorVector FingerController::home(Time now) {
  const bool was_running = homing_.status() == Homing::Status::kRunning;
  const MotorVector torques = homing_.tick(encoders_.angles(), encoders_.velocities(), now);
  if (was_running && homing_.status() == Homing::Status::kDone) {
    encoders_.calibrate(lower_stops_);
    updatePose();
  }
  return torques;
}

void FingerController::startForces(Time now) {
  has_command_ = false;
  command_.rest();
  chain_.start(now);
}

NoForceReason FingerController::mechanicalReason() const {
  if (!has_command_ || chain_.commandsStopped()) return NoForceReason::kNoCommand;
  if (outside_limits_) return NoForceReason::kOutsideLimits;
  if (singular_) return NoForceReason::kSingular;
  return NoForceReason::kNone;
}

ForceInput FingerController::forceInput(bool obeyed) {
  ForceInput input;
  input.desired = chain_.force();
  input.measured = measurement_.force;
  input.measured_now = measured_now_;
  input.sensor_works = sensor_works_;
  input.obeyed = obeyed;
  input.jacobian = jacobian_;
  input.motor_velocities = encoders_.velocities();
  if (!gravity_.isZero(0.0)) {
    input.weight = kinematics_.motorWeight(measurement_.joint_angles) * gravity_;
  }
  return input;
}

MotorVector FingerController::renderForces(NoForceReason hold, Time now) {
  const bool held = hold != NoForceReason::kNone || !has_command_ || outside_limits_ || singular_;
  Vector3d wanted = Vector3d::Zero();
  if (held || chain_.commandsExpired()) {
    command_.rest();
    chain_.interrupt();
  } else {
    wanted = command_.tick(measurement_.pose.translation(), measurement_.velocity);
    if (command_.saturated()) chain_.countSaturated();
  }
  chain_.tick(wanted, measurement_.velocity, now);
  // Who is not asked for a force gives none: neither feedback nor damping outlive the commands.
  if (chain_.stopping()) return control_.release(forceInput(true));
  return control_.tick(forceInput(hold != NoForceReason::kNoDevice));
}

MotorVector FingerController::endForces(Time now) {
  has_command_ = false;
  chain_.stop();
  chain_.tick(Vector3d::Zero(), measurement_.velocity, now);
  return control_.release(forceInput(true));
}

void FingerController::report(NoForceReason hold) {
  measurement_.no_force = hold != NoForceReason::kNone ? hold : mechanicalReason();
  measurement_.desired_force = chain_.force();
  measurement_.safety = chain_.statistics();
}

}  // namespace haptex::exoskeleton
