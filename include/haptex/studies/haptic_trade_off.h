// What accuracy of the haptic layer costs: its settings against a converged reference.
#pragma once

#include <vector>

#include "haptex/oracles/experiments/prescribed_touch.h"

namespace haptex::studies {

/// What a touch should feel, and how far that is from its own limit.
struct TouchReference {
  oracles::ForceRecord record;
  double force = 0.0;  ///< N, root mean square over records and fingertips that touch
  /// N, root mean square and largest: between the record and one on cells of twice the size in
  /// steps of twice the length. Where these converge, the record is nearer to their limit than
  /// that.
  double error = 0.0;
  double worst_error = 0.0;
};

/// @param cell             m, where the fingertips touch
/// @param steps_per_record even, >= 2
/// @throws what computeInOneLayer() throws, std::invalid_argument for steps_per_record
TouchReference computeReference(const oracles::PrescribedTouch& touch, double cell,
                                int steps_per_record);

/// What is traded.
struct HapticPoint {
  contact::HapticSettings haptics;  ///< time_step: a whole multiple of kRecordInterval
  double large_scale_step = 0.012;  ///< s, a whole multiple of haptics.time_step
};

/// Errors in force of a fingertip (N) and computing time on this machine. In a touch with two
/// fingertips the root mean squares are over both, `worst` is that of the worse.
struct HapticCost {
  double force_error = 0.0;   ///< root mean square over the touch
  double worst_error = 0.0;   ///< largest
  double rest_error = 0.0;    ///< root mean square over the second half of the rest at the end
  std::size_t particles = 0;  ///< of the patch at the end
  int rejected_steps = 0;     ///< of both layers
  /// s of the thread's processor time: median of the ticks with a patch, without the exchange of
  /// patches and the arrival of a state.
  double tick_time = 0.0;
  double large_scale_time = 0.0;  ///< s per simulated second: cloth, query and patches

  /// s per simulated second of the force loop.
  double forceLoopTime(const HapticPoint& point) const {
    return tick_time / point.haptics.time_step;
  }
};

/// Runs both layers (HapticLoop) and compares what the device would render: between two ticks the
/// linearised force, as the driver evaluates it.
/// @throws std::invalid_argument naming a step that is not a whole multiple, or a record of another
///   length than the touch's
HapticCost measureTouch(const oracles::PrescribedTouch& touch, const HapticPoint& point,
                        const TouchReference& reference);

struct ErrorAndTime {
  double error;
  double time;
};
/// Per point whether another one beats it: errs no more and takes no longer, and less in one of
/// both. The others are the front.
std::vector<char> isDominated(const std::vector<ErrorAndTime>& points);

}  // namespace haptex::studies
