#include "haptex/tactile/drive_waveform.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {
namespace {

double requireRate(double sample_rate) {
  if (std::isfinite(sample_rate) && sample_rate > 2.0 * kChannelFrequencies[k320]) {
    return sample_rate;
  }
  std::ostringstream message;
  message << "the sample rate is " << sample_rate << " Hz: allowed are finite numbers above "
          << 2.0 * kChannelFrequencies[k320] << " Hz";
  throw std::invalid_argument(message.str());
}

}  // namespace

DriveWaveform::DriveWaveform(double sample_rate) : sample_rate_(requireRate(sample_rate)) {
  samples_.reserve(static_cast<std::size_t>(sample_rate * kTactileStep) + 2);
}

const std::vector<PerContactor<double>>& DriveWaveform::step(const ArrayAmplitudes& next) {
  samples_.clear();
  const double begin = static_cast<double>(steps_) * kTactileStep;
  const double end = static_cast<double>(++steps_) * kTactileStep;
  for (double time; (time = static_cast<double>(sample_) / sample_rate_) < end; ++sample_) {
    const double share = (time - begin) / kTactileStep;
    PerChannel<double> sines;
    for (const Channel channel : {k40, k320}) {
      // Whole turns taken off first: after hours the product would have lost its digits.
      const double turns = std::fmod(kChannelFrequencies[channel] * time, 1.0);
      sines[channel] = std::sin(2.0 * M_PI * turns);
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
