#include "haptex/exoskeleton/control/auto_recovery.h"

namespace haptex::exoskeleton {

RecoveryStep AutoRecovery::next(const OperatingState& state, bool stall, Time now) {
  RecoveryStep step = RecoveryStep::kNone;
  if (state.mode == Mode::kEnabled) {
    step = enabled(now);
  } else if (state.mode == Mode::kFault) {
    step = faulted(stall, now);
  } else if (!recovering_) {
    was_enabled_ = false;  // a person wants no forces
  } else if (!state.is_busy) {
    step = state.is_homed ? RecoveryStep::kEnable : RecoveryStep::kHome;
  }
  last_mode_ = state.mode;
  if (step == RecoveryStep::kNone || step == RecoveryStep::kGiveUp) return step;
  if (now < due_) return RecoveryStep::kNone;
  due_ = now + kPeriod;
  return step;
}

RecoveryStep AutoRecovery::enabled(Time now) {
  if (last_mode_ != Mode::kEnabled) {
    enabled_since_ = now;
    if (!recovering_) in_a_row_ = 0;  // a person has enabled it
  }
  if (now - enabled_since_ >= kSteady) in_a_row_ = 0;
  was_enabled_ = true;
  recovering_ = false;
  return RecoveryStep::kNone;
}

RecoveryStep AutoRecovery::faulted(bool stall, Time now) {
  const bool is_new = last_mode_ != Mode::kFault;
  if (is_new) {
    recovering_ = stall && (was_enabled_ || recovering_) && in_a_row_ < kMaxInARow;
    const bool gives_up = stall && was_enabled_ && !recovering_;
    if (!recovering_) was_enabled_ = false;
    if (gives_up) return RecoveryStep::kGiveUp;
    ++in_a_row_;
    due_ = now + kPeriod;
  }
  return recovering_ ? RecoveryStep::kClearFault : RecoveryStep::kNone;
}

}  // namespace haptex::exoskeleton
