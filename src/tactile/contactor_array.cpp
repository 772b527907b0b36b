#include "haptex/tactile/contactor_array.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {
namespace {

void requireLimit(bool sound, const char* name, double value, const char* allowed) {
  if (sound) return;
  std::ostringstream message;
  message << name << " of the array is " << value << ": allowed are " << allowed;
  throw std::invalid_argument(message.str());
}

bool isPositive(double value) { return std::isfinite(value) && value > 0.0; }

bool isSound(const TouchedFabric& touched) {
  return touched.stroke.velocity.allFinite() && std::isfinite(touched.stroke.normal_force) &&
         touched.placement.origin.allFinite() && touched.placement.axes.allFinite() &&
         std::all_of(touched.forces.begin(), touched.forces.end(),
                     [](double force) { return std::isfinite(force); });
}

/// Share of the vibration that a contactor takes on. Nothing pulls: less than 0 is none.
double shareOf(double force) { return force > 0.0 ? force / (force + kHalfForce) : 0.0; }

}  // namespace

void requireSound(const ArrayLimits& limits) {
  requireLimit(isPositive(limits.lowest_frequency), "the lowest frequency", limits.lowest_frequency,
               "finite numbers > 0 Hz");
  requireLimit(
      std::isfinite(limits.highest_frequency) && limits.highest_frequency > limits.lowest_frequency,
      "the highest frequency", limits.highest_frequency, "finite numbers above the lowest, Hz");
  requireLimit(isPositive(limits.largest_displacement), "the largest displacement",
               limits.largest_displacement, "finite numbers > 0 m");
}

ArrayAmplitudes arrayAmplitudes(const Surface& surface, const TouchedFabric& touched,
                                const ArrayLimits& limits) {
  ArrayAmplitudes amplitudes{};
  if (!isSound(touched)) return amplitudes;
  const PerChannel<double> of_stroke = strokeAmplitudes(surface.small_scale, touched.stroke);
  for (int i = 0; i < kContactors; ++i) {
    const double share = shareOf(touched.forces[i]);
    if (share == 0.0) continue;
    const PerChannel<double> local = surface.large_scale.at(touched.placement.placeOf(i));
    double sum = 0.0;
    for (const Channel channel : {k40, k320}) {
      if (!limits.delivers(channel)) continue;
      amplitudes[i][channel] = of_stroke[channel] * local[channel] * share;
      sum += amplitudes[i][channel];
    }
    if (sum <= limits.largest_displacement) continue;
    for (double& amplitude : amplitudes[i]) amplitude *= limits.largest_displacement / sum;
  }
  return amplitudes;
}

}  // namespace haptex::tactile
