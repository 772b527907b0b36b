#include "haptex/tactile/drive_waveform.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {
namespace {

double requireRate(double sample_rate) {
  constexpr double kLowest = 2.0 * kChannelFrequencies[k320];
  if (sample_rate > kLowest && sample_rate <= kHighestSampleRate) return sample_rate;
  std::ostringstream message;
  message << "the sample rate is " << sample_rate << " Hz: allowed are numbers above " << kLowest
          << " Hz and up to " << kHighestSampleRate << " Hz";
  throw std::invalid_argument(message.str());
}

}  // namespace

DriveWaveform::DriveWaveform(double sample_rate) : sample_rate_(requireRate(sample_rate)) {
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
    PerChannel<double> sines;
    for (const Channel channel : {k40, k320}) {
      // Whole turns taken off where all is exact: the phase is as good after years as at first.
      const double turned =
          std::fmod(kChannelFrequencies[channel] * static_cast<double>(sample_), sample_rate_);
      sines[channel] = std::sin(2.0 * M_PI * turned / sample_rate_);
    }
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
