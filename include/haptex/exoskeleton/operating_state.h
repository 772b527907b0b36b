// The states of the device as CRTK names them.
#pragma once

namespace haptex::exoskeleton {

enum class Mode { kDisabled, kEnabled, kPaused, kFault };

/// "DISABLED", "ENABLED", "PAUSED" or "FAULT".
const char* name(Mode mode);

struct OperatingState {
  Mode mode = Mode::kDisabled;
  bool is_homed = false;  ///< the encoders are calibrated since the device was switched on
  bool is_busy = false;   ///< homing
};

}  // namespace haptex::exoskeleton
