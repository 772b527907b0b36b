#include "haptex/tactile/channels.h"

#include <cmath>

namespace haptex::tactile {

double gain(Channel channel, double frequency) {
  const double ratio = frequency / kChannelFrequencies[channel];
  const double detuning = ratio - 1.0 / ratio;  // infinite at 0 Hz, where the gain so is 0
  const double once = 1.0 / (1.0 + detuning * detuning);
  return channel == k40 ? std::sqrt(once) : once;
}

}  // namespace haptex::tactile
