// The states of the device as CRTK names them, and what leads from one to another.
#pragma once

#include <string>

namespace haptex::exoskeleton {

enum class Mode { kDisabled, kEnabled, kPaused, kFault };

/// "DISABLED", "ENABLED", "PAUSED" or "FAULT".
const char* name(Mode mode);

struct OperatingState {
  Mode mode = Mode::kDisabled;
  bool is_homed = false;  ///< the encoders are calibrated since the device was switched on
  bool is_busy = false;   ///< homing
};

/// Why a request was refused; empty if it was accepted.
using Refusal = std::string;

/// Keeps the operating state. A refused request changes nothing. Forces are rendered in kEnabled
/// only; from kFault a person gets out by clearFault() only.
class OperatingStateMachine {
 public:
  OperatingStateMachine();

  /// From kDisabled and kPaused, with a device, homed and not homing.
  Refusal enable(bool has_device);
  /// From kEnabled.
  Refusal pause();
  /// From any mode but kFault. Ends homing.
  Refusal disable();
  /// From kDisabled, with a device. is_busy from now on.
  Refusal home(bool has_device);
  /// From kFault to kDisabled. @param persists what still is wrong, empty if nothing
  Refusal clearFault(const std::string& persists);

  /// Homing has succeeded: is_homed and no longer is_busy. Ignored unless is_busy.
  void homed();
  /// The calibration is lost. Ends homing.
  void loseHoming();
  /// Latches a fault and ends homing. The first one stays until it is cleared. Does not allocate;
  /// a text longer than 250 characters is cut.
  void raiseFault(const char* why);

  const OperatingState& state() const { return state_; }
  /// What latched the fault; empty without one.
  const std::string& fault() const { return fault_; }

 private:
  OperatingState state_;
  std::string fault_;
};

}  // namespace haptex::exoskeleton
