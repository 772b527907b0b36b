#include "haptex/exoskeleton/control/device_controller.h"

#include <algorithm>
#include <cstdio>

namespace haptex::exoskeleton {
namespace {

using Status = Homing::Status;

const char* const kLost = "no states from the device";

const char* describe(Status status) {
  switch (status) {
    case Status::kNoRest:
      return "did not come to rest on its stop within 10 s";
    case Status::kTurnedTooFar:
      return "turned further than its range: its transmission slips";
    case Status::kStuck:
      return "did not leave its stop: it is jammed, or its encoder is dead";
    case Status::kDifferentPlace:
      return "found its stop at two different places";
    case Status::kIdle:
    case Status::kRunning:
    case Status::kDone:
      break;
  }
  return "";
}

}  // namespace

DeviceController::DeviceController(const std::string& urdf)
    : fingers_{{FingerController(urdf, Finger::kIndex), FingerController(urdf, Finger::kThumb)}} {}

Refusal DeviceController::enable() {
  const Refusal refusal = states_.enable(has_device_);
  if (!refusal.empty()) return refusal;
  for (FingerController& finger : fingers_.values) finger.startForces(now_);
  forces_on_ = true;
  return refusal;
}

Refusal DeviceController::disable() { return states_.disable(); }

Refusal DeviceController::pause() { return states_.pause(); }

Refusal DeviceController::home() {
  const Refusal refusal = states_.home(has_device_);
  if (!refusal.empty()) return refusal;
  for (FingerController& finger : fingers_.values) finger.startHoming(now_);
  return refusal;
}

Refusal DeviceController::clearFault() {
  const Refusal refusal = states_.clearFault(device_lost_ && !has_device_ ? kLost : "");
  if (!refusal.empty()) return refusal;
  device_lost_ = false;
  for (FingerController& finger : fingers_.values) finger.clearFault();
  return refusal;
}

void DeviceController::command(Finger finger, const ForceCommand& command, Time now) {
  fingers_[finger].command(command, operatingState().mode == Mode::kEnabled, now);
}

void DeviceController::raiseFault(const std::string& why) { latch(why.c_str()); }

void DeviceController::latch(const char* why) {
  states_.raiseFault(why);
  for (FingerController& finger : fingers_.values) finger.latchFault();
}

void DeviceController::accept(const DeviceState& state, Time now) {
  const bool another_life = !clock_.receive(state.time, now);
  const double dt = state_seen_ ? 1e-6 * (state.time - device_time_) : 0.0;
  if (another_life) {
    for (FingerController& finger : fingers_.values) finger.restartEncoders();
  }
  const Finger* jumped = nullptr;
  for (const Finger& finger : kFingers) {
    if (!fingers_[finger].measure(state.fingers[finger], dt)) jumped = &finger;
  }
  if (another_life || jumped != nullptr) {
    if (another_life) {
      latch("the device was switched off and on again: its clock jumped");
    } else {
      latch(*jumped == Finger::kIndex ? "an encoder of the index finger jumped"
                                      : "an encoder of the thumb jumped");
      fingers_[*jumped].restartEncoders();
    }
    states_.loseHoming();
  }
  followEcho(state, now);
  device_time_ = state.time;
  device_tripped_ = state.watchdog_tripped;
  last_state_ = now;
  state_seen_ = has_device_ = true;
}

void DeviceController::followEcho(const DeviceState& state, Time now) {
  const bool newer = state.last_command != echo_;
  if (state_seen_ && newer) echoes_ = true;
  if (newer || !echoes_) last_echo_ = now;
  echo_ = state.last_command;
}

void DeviceController::watchDevice(Time now) {
  if (state_seen_ && now - last_state_ <= kStateTimeout) return;
  has_device_ = false;
  const bool motors_on = operatingState().mode == Mode::kEnabled || operatingState().is_busy;
  if (!motors_on || (state_seen_ && now - last_state_ <= kLostAfter)) return;
  device_lost_ = true;
  latch(kLost);
}

// Whatever ended homing, the state machine knows.
void DeviceController::home(Time now) {
  command_.mode = DriveMode::kHoming;
  bool done = true;
  for (const Finger finger : kFingers) {
    FingerController& controller = fingers_[finger];
    command_.torques[finger] = controller.home(now);
    const Status status = controller.homing().status();
    if (status != Status::kDone) done = false;
    if (status == Status::kDone || status == Status::kRunning) continue;
    const int joint = std::max(controller.homing().culprit(), 0);
    char text[200];
    std::snprintf(text, sizeof text, "homing failed: %s %s",
                  controller.kinematics().jointNames()[static_cast<std::size_t>(joint)].c_str(),
                  describe(status));
    latch(text);
    return;
  }
  if (done) states_.homed();
}

void DeviceController::driveFingers(Time now) {
  command_.mode = DriveMode::kForce;
  const bool enabled = operatingState().mode == Mode::kEnabled;
  const NoForceReason why = hold(now);
  bool ended = true;
  for (const Finger finger : kFingers) {
    FingerController& controller = fingers_[finger];
    command_.torques[finger] =
        enabled ? controller.renderForces(why, now) : controller.endForces(now);
    if (!controller.forcesEnded()) ended = false;
  }
  forces_on_ = enabled || !ended;
}

NoForceReason DeviceController::hold(Time now) const {
  const OperatingState& state = operatingState();
  const bool obeys = now - last_echo_ <= kRoundTrip && now - last_state_ <= kRoundTrip;
  if (!has_device_) return NoForceReason::kNoDevice;
  if (state.mode == Mode::kFault) return NoForceReason::kFault;
  if (state.is_busy) return NoForceReason::kHoming;
  if (!state.is_homed) return NoForceReason::kNotHomed;
  if (state.mode == Mode::kDisabled) return NoForceReason::kDisabled;
  if (state.mode == Mode::kPaused) return NoForceReason::kPaused;
  if (!obeys || device_tripped_) return NoForceReason::kNoDevice;
  return NoForceReason::kNone;
}

void DeviceController::observe(const DeviceState* state, Time now) {
  now_ = now;
  for (FingerController& finger : fingers_.values) finger.noReading();
  if (state != nullptr) accept(*state, now);
  watchDevice(now);
}

const DeviceCommand& DeviceController::drive(Time now) {
  now_ = now;
  command_ = DeviceCommand();
  const Eigen::Vector3d& gravity = gravity_.tick(now);
  for (FingerController& finger : fingers_.values) finger.setGravity(gravity);
  if (operatingState().is_busy) {
    home(now);
  } else if (forces_on_) {
    driveFingers(now);
  }
  const bool motors_on = operatingState().is_busy || forces_on_;
  if (!motors_on) command_ = DeviceCommand();
  const NoForceReason why = hold(now);
  for (FingerController& finger : fingers_.values) finger.report(why);
  return command_;
}

}  // namespace haptex::exoskeleton
