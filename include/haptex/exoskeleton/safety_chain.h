// The one place that every force goes through before it becomes torque.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptex/exoskeleton/clock.h"
#include "haptex/exoskeleton/passivity_controller.h"

namespace haptex::exoskeleton {

constexpr double kMaximumForce = 5.0;    ///< N, continuous force of the device
constexpr double kMaximumSlew = 1000.0;  ///< N/s, of the norm of the change
constexpr double kSoftStart = 0.5;       ///< s, from nothing to the whole force after enabling
constexpr Time kCommandTimeout = std::chrono::milliseconds(10);  ///< then the watchdog ramps
constexpr Time kWatchdogRamp = std::chrono::milliseconds(5);     ///< from the whole force to zero
/// Longest time (s) that the slew limit takes for a period: after a late tick the force must not
/// jump by what it might have done meanwhile.
constexpr double kLongestSlew = 0.002;

/// Counts since the construction, no units, and the observed energy.
struct SafetyStatistics {
  std::uint64_t not_finite = 0;    ///< commands or measurements that were not finite
  std::uint64_t saturated = 0;     ///< ticks in which the commanded norm exceeded kMaximumForce
  std::uint64_t slew_limited = 0;  ///< ticks
  std::uint64_t passivity_limited = 0;  ///< ticks in which the passivity controller dissipated
  std::uint64_t watchdog_trips = 0;     ///< times the commands stopped while a force was rendered
  double observed_energy = 0.0;         ///< J, see PassivityController
};

/// The stages, in their order. Forces in N, times in s.

/// The vector, or zero if a component is not finite. @param finite whether it was
Eigen::Vector3d finiteOrZero(const Eigen::Vector3d& vector, bool& finite);

/// The finite force, shortened to `limit` if its norm is above.
Eigen::Vector3d saturated(const Eigen::Vector3d& force, double limit);

/// From `previous` towards `target`, by at most kMaximumSlew * min(dt, kLongestSlew).
Eigen::Vector3d slewLimited(const Eigen::Vector3d& target, const Eigen::Vector3d& previous,
                            double dt);

/// The share of the force that is let through `since_start` after enabling: a straight line from 0
/// to 1 within kSoftStart.
double softStartGain(double since_start);

/// The next point of a straight line from `previous`, at `before`, to zero at `end`. Used by
/// watchdog and fault: if the norm of what they start from is at most kMaximumForce, the line
/// obeys kMaximumSlew, because kWatchdogRamp = kMaximumForce / kMaximumSlew.
Eigen::Vector3d rampedDown(const Eigen::Vector3d& previous, Time before, Time now, Time end);

/// One finger's chain: isfinite, saturation, slew limit, passivity, soft start, watchdog, latched
/// fault, and clamped again last. Whatever goes in and however irregular the ticks are, what comes
/// out is finite, at most kMaximumForce, and differs from what came out before by at most
/// kMaximumSlew * min(period, kLongestSlew). Ticked every millisecond, it is zero at the latest
/// kCommandTimeout + kWatchdogRamp + one period after the last command.
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

  /// A command or measurement was dropped because it was not finite.
  void countNotFinite() { ++statistics_.not_finite; }

  /// The command of the coming tick was shortened to kMaximumForce before it came here.
  void countSaturated() { ++statistics_.saturated; }

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
  /// True if no command has been accepted yet or the last one is too old, as of the last tick.
  bool commandsStopped() const { return commands_stopped_; }
  bool faultLatched() const { return fault_latched_; }
  /// True if watchdog or fault take the force to zero or keep it there.
  bool stopping() const { return commands_stopped_ || fault_latched_; }
  const SafetyStatistics& statistics() const { return statistics_; }

 private:
  Eigen::Vector3d watchdog(const Eigen::Vector3d& force, Time now);
  Eigen::Vector3d latchedFault(const Eigen::Vector3d& force, Time now) const;

  SafetyStatistics statistics_;
  PassivityController passivity_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();   ///< what left the chain
  Eigen::Vector3d slewed_ = Eigen::Vector3d::Zero();  ///< what left the slew limit
  Time last_tick_{0};
  Time start_{0};
  Time last_command_{0};
  Time fault_end_{0};  ///< when the force of a latched fault has to be zero
  bool ticked_ = false;
  bool started_ = false;
  bool command_seen_ = false;
  bool commands_stopped_ = true;
  bool fault_latched_ = false;
};

}  // namespace haptex::exoskeleton
