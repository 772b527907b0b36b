// The one place that every force goes through before it becomes torque.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptex/exoskeleton/control/passivity_controller.h"
#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

constexpr double kMaxForce = 5.0;    ///< N, continuous force of the device
constexpr double kMaxSlew = 1000.0;  ///< N/s, of the norm of the change
constexpr double kSoftStart = 0.5;   ///< s, from nothing to the whole force after enabling
/// The last command is held for so long: it is passive by itself (command_check.h), so that
/// messages that are late do not open the hand. Then the watchdog ramps.
constexpr Time kCommandTimeout = std::chrono::microseconds(12500);
constexpr Time kWatchdogRamp = std::chrono::milliseconds(5);  ///< from the largest force to zero
/// s, from nothing to the whole force after an interruption: meanwhile the fingers have closed in,
/// and a force that jumps back throws them apart.
constexpr double kReturn = 0.08;
/// Longest time (s) that the slew limit takes for a period: after a late tick the force must not
/// jump by what it might have done meanwhile.
constexpr double kLongestSlew = 0.002;

/// Counts since the construction, no units, and the observed energy.
struct SafetyStatistics {
  std::uint64_t not_finite = 0;         ///< commands or measurements that were not finite
  std::uint64_t saturated = 0;          ///< ticks in which the commanded norm exceeded kMaxForce
  std::uint64_t slew_limited = 0;       ///< ticks
  std::uint64_t passivity_limited = 0;  ///< ticks in which the passivity controller dissipated
  std::uint64_t watchdog_trips = 0;     ///< times the commands stopped while a force was rendered
  double observed_energy = 0.0;         ///< J, see PassivityController
};

/// The stages, in their order. Forces in N, times in s.

/// The vector, or zero if a component is not finite. @param finite whether it was
Eigen::Vector3d finiteOrZero(const Eigen::Vector3d& vector, bool& finite);

/// The finite force, shortened to `limit` if its norm is above.
Eigen::Vector3d saturated(const Eigen::Vector3d& force, double limit);

/// From `previous` towards `target`, by at most kMaxSlew * min(dt, kLongestSlew).
Eigen::Vector3d slewLimited(const Eigen::Vector3d& target, const Eigen::Vector3d& previous,
                            double dt);

/// The share of the force that is let through `since_start` after enabling: a straight line from 0
/// to 1 within kSoftStart.
double softStartGain(double since_start);

/// Alike after an interruption, within kReturn.
double returnGain(double since_return);

/// The next point of a straight line from `previous`, at `before`, to zero at `end`. Used by a
/// latched fault: if the norm of what it starts from is at most kMaxForce, the line obeys
/// kMaxSlew, because kWatchdogRamp = kMaxForce / kMaxSlew.
Eigen::Vector3d rampedDown(const Eigen::Vector3d& previous, Time before, Time now, Time end);

/// One finger's chain: isfinite, saturation, slew limit, passivity, soft start, return, watchdog,
/// latched fault, and clamped again last. Whatever goes in and however irregular the ticks are,
/// what comes out is finite, at most kMaxForce, and differs from what came out before by at
/// most kMaxSlew * min(period, kLongestSlew). Ticked every millisecond, it is zero at the
/// latest kCommandTimeout + kWatchdogRamp + one period after the last command, and kWatchdogRamp +
/// one period after the commander is known to be dead.
///
/// The watchdog lets through kMaxSlew times the time that is left until then: a force of less
/// than kMaxForce is held for longer, and goes to zero as steeply.
///
/// Not thread-safe, does not allocate.
class SafetyChain {
 public:
  /// Forces are to be rendered from now on: soft start from zero, observed energy zero, and the
  /// commands accepted before count no more. Before the first start no force comes out.
  void start(Time now);

  /// No forces from now on: whatever is asked for, the force goes to zero at the slew limit.
  void stop() { started_ = false; }

  /// A command has been accepted: the watchdog waits kCommandTimeout for the next one.
  void commandAccepted(Time now);

  /// Nobody commands any more, which is more than that no command came: the force goes to zero at
  /// the slew limit, from the next tick on, until a command is accepted.
  void commanderDied(Time now);

  /// A command or measurement was dropped because it was not finite.
  void countNotFinite() { ++statistics_.not_finite; }

  /// The command of the coming tick was shortened to kMaxForce before it came here.
  void countSaturated() { ++statistics_.saturated; }

  /// There is no force to be rendered for a moment: when there is one again it comes back within
  /// kReturn, as it does where the commands had expired. After a tick that came so late that the
  /// device's watchdog has taken a share of the torques (FirmwareModel), it comes back from the
  /// rest.
  void interrupt() { interrupted_ = true; }

  /// Latches: the force goes to zero within kWatchdogRamp, from the next tick on, and stays there
  /// until clearFault().
  void latchFault();
  void clearFault() { fault_latched_ = false; }

  /// One period. @param wanted N, the force asked for @param velocity m/s, measured
  /// @param now not before that of the last tick; if it is, the force stays as it was
  /// @returns N, what may be rendered
  const Eigen::Vector3d& tick(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity,
                              Time now);

  /// What the last tick returned (N).
  const Eigen::Vector3d& force() const { return force_; }
  /// True if no command has been accepted yet or the last one is older than kCommandTimeout, as of
  /// the last tick.
  bool commandsStopped() const { return commands_stopped_; }
  /// True if there are to be no forces for want of commands, as of the last tick.
  bool commandsExpired() const { return commands_expired_; }
  bool faultLatched() const { return fault_latched_; }
  /// True if watchdog or fault take the force to zero or keep it there.
  bool stopping() const { return commands_stopped_ || fault_latched_; }
  const SafetyStatistics& statistics() const { return statistics_; }

 private:
  Eigen::Vector3d watchdog(const Eigen::Vector3d& force, Time now, double dt);
  Time commandsEnd() const { return last_command_ + kCommandTimeout + kWatchdogRamp; }
  Eigen::Vector3d latchedFault(const Eigen::Vector3d& force, Time now) const;

  SafetyStatistics statistics_;
  PassivityController passivity_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();   ///< what left the chain
  Eigen::Vector3d slewed_ = Eigen::Vector3d::Zero();  ///< what left the slew limit
  Time last_tick_{0};
  Time start_{0};
  Time last_command_{0};
  Time fault_end_{0};  ///< when the force of a latched fault has to be zero
  Time return_{0};     ///< when the force has begun to come back
  bool interrupted_ = false;
  bool ticked_ = false;
  bool started_ = false;
  bool command_seen_ = false;
  bool commands_stopped_ = true;
  bool commands_expired_ = true;
  bool fault_latched_ = false;
};

}  // namespace haptex::exoskeleton
