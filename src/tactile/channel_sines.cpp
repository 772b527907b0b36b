#include "haptex/tactile/channel_sines.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {

double requireSampleRate(double sample_rate) {
  constexpr double kLowest = 2.0 * kChannelFrequencies[k320];
  if (sample_rate > kLowest && sample_rate <= kHighestSampleRate) return sample_rate;
  std::ostringstream message;
  message << "the sample rate is " << sample_rate << " Hz: allowed are numbers above " << kLowest
          << " Hz and up to " << kHighestSampleRate << " Hz";
  throw std::invalid_argument(message.str());
}

PerChannel<double> sinesAt(long long sample, double sample_rate) {
  PerChannel<double> sines;
  for (const Channel channel : {k40, k320}) {
    const double turned =
        std::fmod(kChannelFrequencies[channel] * static_cast<double>(sample), sample_rate);
    sines[channel] = std::sin(2.0 * M_PI * turned / sample_rate);
  }
  return sines;
}

}  // namespace haptex::tactile
