#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile {

DriveWaveform::DriveWaveform(double sample_rate) : sample_rate_(requireSampleRate(sample_rate)) {
  samples_.reserve(static_cast<std::size_t>(sample_rate * kTactileStep) + 2);
}

const std::vector<PerContactor<double>>& DriveWaveform::step(const ArrayAmplitudes& next) {
  samples_.clear();
  // Counted in samples from the start: rounding does not add up.
  const double per_step = sample_rate_ / kTactileRate;
  const double begin = static_cast<double>(steps_) * sample_rate_ / kTactileRate;
  const double end = static_cast<double>(++steps_) * sample_rate_ / kTactileRate;
  for (; static_cast<double>(sample_) < end; ++sample_) {
    const double share = (static_cast<double>(sample_) - begin) / per_step;
    const PerChannel<double> sines = sinesAt(sample_, sample_rate_);
    PerContactor<double>& displacements = samples_.emplace_back();
    for (int i = 0; i < kContactors; ++i) {
      displacements[i] = 0.0;
      for (const Channel channel : {k40, k320}) {
        const double amplitude =
            amplitudes_[i][channel] + share * (next[i][channel] - amplitudes_[i][channel]);
        displacements[i] += amplitude * sines[channel];
      }
    }
  }
  amplitudes_ = next;
  return samples_;
}

}  // namespace haptex::tactile
