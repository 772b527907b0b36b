#include "haptex/tactile/stroke.h"

#include <algorithm>
#include <cmath>

namespace haptex::tactile {
namespace {

constexpr double kRest = 1e-9;  // m/s: slower is no movement

/// Power that a wave felt at a frequency adds by friction, over its own.
double frictionShare(double friction, double slope, double frequency) {
  const double ratio = frequency / kSkinCorner;
  const double displacement = friction * slope / kSkinStiffness;
  return displacement * displacement / (1.0 + ratio * ratio);
}

bool moves(const Stroke& stroke) {
  return stroke.velocity.allFinite() && std::isfinite(stroke.normal_force) &&
         stroke.velocity.norm() > kRest;
}

}  // namespace

PerChannel<double> strokeAmplitudes(const SmallScale& surface, const Stroke& stroke) {
  if (!moves(stroke)) return {};
  const KSpace& waves = surface.waves;
  const double speed = stroke.velocity.norm();
  const Eigen::Vector2d turns = stroke.velocity / (2.0 * M_PI);
  const double friction = surface.friction_per_slope * stroke.normal_force;
  double sum_40 = 0.0, sum_320 = 0.0;
  // The filters of channels.h squared, written out so that the compiler takes several waves at
  // once.
  const double over_40 = 1.0 / kChannelFrequencies[k40];
  const double over_320 = 1.0 / kChannelFrequencies[k320];
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double frequency = std::abs(waves.weft[i] * turns.x() + waves.warp[i] * turns.y());
    const double slope = 2.0 * M_PI * frequency / speed;
    const double power = waves.power[i] * (1.0 + frictionShare(friction, slope, frequency));
    const double r40 = frequency * over_40 * (frequency * over_40);
    const double r320 = frequency * over_320 * (frequency * over_320);
    const double once_40 = r40 / (r40 + (r40 - 1.0) * (r40 - 1.0));
    const double once_320 = r320 / (r320 + (r320 - 1.0) * (r320 - 1.0));
    sum_40 += power * once_40;
    sum_320 += power * once_320 * once_320;
  }
  // Numbers too large for a square.
  if (!std::isfinite(sum_40) || !std::isfinite(sum_320)) return {};
  return {std::sqrt(2.0 * sum_40), std::sqrt(2.0 * sum_320)};
}

std::vector<SpectralLine> strokeSpectrum(const SmallScale& surface, const Stroke& stroke) {
  std::vector<SpectralLine> lines;
  if (!moves(stroke)) return lines;
  const KSpace& waves = surface.waves;
  const double speed = stroke.velocity.norm();
  const double friction = surface.friction_per_slope * stroke.normal_force;
  lines.reserve(waves.size());
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double turning =
        std::abs(waves.weft[i] * stroke.velocity.x() + waves.warp[i] * stroke.velocity.y());
    const double frequency = turning / (2.0 * M_PI);
    const double share = frictionShare(friction, turning / speed, frequency);
    lines.push_back({frequency, waves.power[i] * (1.0 + share)});
  }
  std::sort(lines.begin(), lines.end(),
            [](const SpectralLine& a, const SpectralLine& b) { return a.frequency < b.frequency; });
  return lines;
}

}  // namespace haptex::tactile
