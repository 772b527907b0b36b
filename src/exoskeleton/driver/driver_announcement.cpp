#include "haptex/exoskeleton/driver/driver_announcement.h"

namespace haptex::exoskeleton {

std::string announcement(const OperatingState& state, const std::string& fault) {
  const std::string enable =
      state.is_homed ? "exoskeleton/enable" : "exoskeleton/home, then exoskeleton/enable";
  switch (state.mode) {
    case Mode::kEnabled:
      return "ENABLED: commanded forces are rendered";
    case Mode::kPaused:
      return "PAUSED: forces are off. Call exoskeleton/enable";
    case Mode::kFault:
      return "FAULT: " + fault + "; forces are off. Call exoskeleton/clear_fault, then " + enable;
    case Mode::kDisabled:
      break;
  }
  if (state.is_busy) return "DISABLED, homing: the motors move the fingers to their stops";
  const char* homed = state.is_homed ? "" : ", not homed";
  return std::string("DISABLED") + homed + ": forces are off. Call " + enable;
}

}  // namespace haptex::exoskeleton
