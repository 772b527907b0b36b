// Which commanded forces are believed. Messages come from outside: nothing in them is.
#pragma once

#include <haptex/ServoForce.h>
#include <ros/time.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/exoskeleton/control/force_command.h"

namespace haptex::nodes {

/// Why a commanded force is dropped, in the order in which it is looked for.
enum class ServoForceFlaw {
  kFrame,      ///< frame_id is not handFrame()
  kNotFinite,  ///< a number is NaN or infinite
  kTooLarge,   ///< a number is beyond the bounds of exoskeleton/command_check.h
  kActive,     ///< stiffness or damping is not symmetric and positive semidefinite
  kTooOld,     ///< stamped more than kStampTolerance before the driver's clock
  kTooNew,     ///< stamped more than kStampTolerance after it
  kOrder,      ///< not stamped later than the last one taken
};

constexpr std::array<ServoForceFlaw, 7> kServoForceFlaws{
    ServoForceFlaw::kFrame,  ServoForceFlaw::kNotFinite, ServoForceFlaw::kTooLarge,
    ServoForceFlaw::kActive, ServoForceFlaw::kTooOld,    ServoForceFlaw::kTooNew,
    ServoForceFlaw::kOrder};

/// In two or three words, for diagnostics.
const char* name(ServoForceFlaw flaw);

/// Takes the commanded forces of one finger and counts those it drops.
class ServoForceFilter {
 public:
  static constexpr base::Time kStampTolerance = std::chrono::milliseconds(20);
  /// After this long without a command taken the next may have any stamp within the tolerance, so
  /// that a commander that was started anew, or a clock that was set back, is believed again.
  static constexpr base::Time kForgetAfter = std::chrono::milliseconds(100);

  /// By one thread. @param now of ROS @param steady_now of the steady clock
  /// @returns the command, or nothing if the message has a flaw: see lastFlaw()
  std::optional<exoskeleton::ForceCommand> receive(const haptex::ServoForce& message,
                                                   const ros::Time& now, base::Time steady_now);

  /// By the same thread: of the last command taken.
  const ros::Time& lastStamp() const { return last_stamp_; }

  /// By the same thread: the commander has died. What it had stamped before and comes only now is
  /// dropped.
  void commanderDied(const ros::Time& now, base::Time steady_now) {
    last_stamp_ = now;
    last_time_ = steady_now;
  }

  /// By the same thread: what was wrong with the last message dropped, and what is allowed. Made
  /// of the arguments of that receive().
  std::string explain(const haptex::ServoForce& message, const ros::Time& now) const;

  /// By any thread. Counts since the construction, no units.
  std::uint64_t dropped(ServoForceFlaw flaw) const;
  std::uint64_t accepted() const { return accepted_.load(std::memory_order_relaxed); }

 private:
  std::optional<ServoForceFlaw> findFlaw(const haptex::ServoForce& message, const ros::Time& now,
                                         base::Time steady_now) const;

  ServoForceFlaw last_flaw_ = ServoForceFlaw::kFrame;
  ros::Time last_stamp_;                 // of the last command taken
  std::optional<base::Time> last_time_;  // when it was taken; none: none yet
  std::atomic<std::uint64_t> accepted_{0};
  std::array<std::atomic<std::uint64_t>, kServoForceFlaws.size()> dropped_{};
};

}  // namespace haptex::nodes
