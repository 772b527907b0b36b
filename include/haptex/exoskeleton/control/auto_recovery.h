// What a person would do after a stall: clear the fault, home if needed, enable.
#pragma once

#include "haptex/exoskeleton/control/operating_state.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

enum class RecoveryStep { kNone, kClearFault, kHome, kEnable, kGiveUp };

/// Asks for the next step after a fault that is a stall (DeviceController::faultIsAStall()) of a
/// device that was ENABLED. Any other fault is left to a person, and so is a device that a person
/// has disabled or paused. Forces come back with the soft start of every enabling. After
/// kMaxInARow stalls without kSteady of ENABLED between them it gives up until a person enables.
///
/// Not thread-safe, does not allocate.
class AutoRecovery {
 public:
  static constexpr int kMaxInARow = 3;
  static constexpr Time kSteady = std::chrono::seconds(10);
  /// Between two requests: one that is refused is asked again, for example while the device is
  /// still silent.
  static constexpr Time kPeriod = std::chrono::milliseconds(200);

  /// @param stall the fault, if there is one, is a stall
  RecoveryStep next(const OperatingState& state, bool stall, Time now);

  bool isRecovering() const { return recovering_; }

 private:
  RecoveryStep enabled(Time now);
  RecoveryStep faulted(bool stall, Time now);

  Mode last_mode_ = Mode::kDisabled;
  Time enabled_since_{0};
  Time due_{0};
  int in_a_row_ = 0;
  bool was_enabled_ = false;  // before the fault
  bool recovering_ = false;
};

}  // namespace haptex::exoskeleton
