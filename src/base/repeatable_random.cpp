#include "haptex/base/repeatable_random.h"

#include <cmath>

namespace haptex::base {

double RepeatableRandom::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
}

double RepeatableRandom::logarithmic(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

int RepeatableRandom::below(int count) {
  return static_cast<int>(engine_() % static_cast<std::uint64_t>(count));
}

Eigen::Vector2d RepeatableRandom::inSquare(double low, double high) {
  const double y = uniform(low, high), x = uniform(low, high);
  return {x, y};
}

Eigen::Vector3d RepeatableRandom::direction() {
  const double z = uniform(-1.0, 1.0);
  const double angle = uniform(0.0, 2.0 * M_PI);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace haptex::base
