// The one place that every force goes through before it becomes torque.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "haptex/exoskeleton/clock.h"

namespace haptex::exoskeleton {

constexpr double kMaximumForce = 5.0;    ///< N, continuous force of the device
constexpr double kMaximumSlew = 1000.0;  ///< N/s, of the norm of the change
constexpr double kSoftStart = 0.5;       ///< s, from nothing to the whole force after enabling
constexpr Time kCommandTimeout = std::chrono::milliseconds(10);  ///< then the watchdog ramps
constexpr Time kWatchdogRamp = std::chrono::milliseconds(5);     ///< from the whole force to zero

/// Counts since the construction, no units, and the observed energy.
struct SafetyStatistics {
  std::uint64_t not_finite = 0;    ///< commands or measurements that were not finite
  std::uint64_t saturated = 0;     ///< ticks in which the commanded norm exceeded kMaximumForce
  std::uint64_t slew_limited = 0;  ///< ticks
  std::uint64_t passivity_limited = 0;  ///< ticks in which the passivity controller dissipated
  std::uint64_t watchdog_trips = 0;     ///< times the commands stopped while a force was rendered
  double observed_energy = 0.0;         ///< J, see PassivityObserver
};

}  // namespace haptex::exoskeleton
