#include "haptex/tactile/channels.h"

#include <cmath>

namespace haptex::tactile {

double gain(Channel channel, double frequency) {
  const double ratio = frequency / kChannelFrequencies[channel];
  // 1/(1 + (r - 1/r)^2) without the division by r, which may be zero.
  const double squared = ratio * ratio;
  const double once = squared / (squared + (squared - 1.0) * (squared - 1.0));
  return channel == k40 ? std::sqrt(once) : once;
}

}  // namespace haptex::tactile
