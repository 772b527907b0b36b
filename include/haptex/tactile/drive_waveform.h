// What drives the contactors: the sum of two sines each.
#pragma once

#include <vector>

#include "haptex/tactile/channel_sines.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::tactile {

/// Amplitudes are given for every step of the tactile renderer.
constexpr double kTactileRate = 40.0;                ///< Hz
constexpr double kTactileStep = 1.0 / kTactileRate;  ///< s

/// Displacements of the contactors of one array,
///   z_i(t) = a40_i(t) sin(2 pi 40 t) + a320_i(t) sin(2 pi 320 t),
/// at any sample rate. Phases run on from step to step and from start to end, and amplitudes go to
/// those of the next step along a straight line, so nothing jumps.
class DriveWaveform {
 public:
  /// @param sample_rate Hz
  /// @throws std::invalid_argument what requireSampleRate() throws
  explicit DriveWaveform(double sample_rate);

  /// The samples until the next step, in which the amplitudes reach `next`. The number of samples
  /// varies by one where a step is no whole number of them; n steps have ceil(n rate/kTactileRate).
  /// @param next m, finite
  /// @returns displacements (m), one per sample and contactor; valid until the next call. Allocates
  ///   nothing.
  const std::vector<PerContactor<double>>& step(const ArrayAmplitudes& next);

 private:
  double sample_rate_;
  long long sample_ = 0;  // first of the next step
  long long steps_ = 0;
  ArrayAmplitudes amplitudes_{};
  std::vector<PerContactor<double>> samples_;
};

}  // namespace haptex::tactile
