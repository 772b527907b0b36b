#include "haptex/exoskeleton/control/operating_state.h"

#include <algorithm>
#include <cstring>

namespace haptex::exoskeleton {
namespace {

constexpr std::size_t kLongestFault = 250;
const char* const kNoDevice = "there are no states from the device";

}  // namespace

const char* name(Mode mode) {
  switch (mode) {
    case Mode::kDisabled:
      return "DISABLED";
    case Mode::kEnabled:
      return "ENABLED";
    case Mode::kPaused:
      return "PAUSED";
    case Mode::kFault:
      return "FAULT";
  }
  return "";
}

OperatingStateMachine::OperatingStateMachine() { fault_.reserve(kLongestFault); }

Refusal OperatingStateMachine::enable(bool has_device) {
  if (state_.mode == Mode::kFault) return "a fault is latched, clear it first: " + fault_;
  if (state_.mode == Mode::kEnabled) return "the device is enabled already";
  if (!has_device) return kNoDevice;
  if (state_.is_busy) return "the device is homing";
  if (!state_.is_homed) return "the encoders are not calibrated, home the device first";
  state_.mode = Mode::kEnabled;
  return "";
}

Refusal OperatingStateMachine::pause() {
  if (state_.mode != Mode::kEnabled) {
    return std::string("only an enabled device can be paused, this one is ") + name(state_.mode);
  }
  state_.mode = Mode::kPaused;
  return "";
}

Refusal OperatingStateMachine::disable() {
  if (state_.mode == Mode::kFault) return "a fault is latched, clear it: " + fault_;
  state_.mode = Mode::kDisabled;
  state_.is_busy = false;
  return "";
}

Refusal OperatingStateMachine::home(bool has_device) {
  if (state_.mode != Mode::kDisabled) {
    return std::string("homing needs a DISABLED device, this one is ") + name(state_.mode);
  }
  if (!has_device) return kNoDevice;
  if (state_.is_busy) return "the device is homing already";
  state_.is_busy = true;
  state_.is_homed = false;
  return "";
}

Refusal OperatingStateMachine::clearFault(const std::string& persists) {
  if (state_.mode != Mode::kFault) return "there is no fault";
  if (!persists.empty()) return "the cause of the fault persists: " + persists;
  state_.mode = Mode::kDisabled;
  fault_.clear();
  return "";
}

void OperatingStateMachine::homed() {
  if (!state_.is_busy) return;
  state_.is_busy = false;
  state_.is_homed = true;
}

void OperatingStateMachine::loseHoming() {
  state_.is_busy = false;
  state_.is_homed = false;
}

void OperatingStateMachine::raiseFault(const char* why) {
  if (state_.mode == Mode::kFault) return;
  state_.mode = Mode::kFault;
  state_.is_busy = false;
  fault_.assign(why, std::min(std::strlen(why), kLongestFault));
}

}  // namespace haptex::exoskeleton
