#include "haptex/cloth/forces/self_contact/layer_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/material/compression.h"

namespace haptex::cloth {
namespace {

const material::Compression& requireCompression(const material::Fabric& fabric) {
  if (fabric.compression) return *fabric.compression;
  throw std::invalid_argument("self_collision is modelled and fabric " + base::quoted(fabric.name) +
                              " has no thickness: add the key compression");
}

/// The strain of the pressure at which KES measures last, or of a curve that ends before that.
double lastStrain(const material::StrainStressCurve& pressure) {
  constexpr double kMost = 0.95;
  double low = 0.0, high = std::min(kMost, pressure.lastKnot());
  if (pressure.evaluate(high).stress <= material::kKesHighPressure) return high;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (pressure.evaluate(middle).stress < material::kKesHighPressure ? low : high) = middle;
  }
  return high;
}

}  // namespace

LayerLaw::LayerLaw(const material::Fabric& fabric)
    : compression_(requireCompression(fabric)),
      least_(compression_.thickness * (1.0 - lastStrain(compression_.pressure))) {}

LayerPressure LayerLaw::at(double distance) const {
  if (distance < kTouching) return {at(kTouching).energy, 0.0, 0.0};
  const double thickness = compression_.thickness;
  if (!(distance < thickness)) return {0.0, 0.0, 0.0};
  const double strain = (thickness - std::max(distance, least_)) / thickness;
  const material::CurveValue curve = compression_.pressure.evaluate(strain);
  LayerPressure result = {thickness * compression_.pressure.energy(strain), curve.stress,
                          curve.slope / thickness};
  if (distance < least_) {
    const LayerPressure more = barrier(distance, result.slope);
    const double beyond = least_ - distance;
    result.energy += beyond * (result.pressure + 0.5 * beyond * result.slope) + more.energy;
    result.pressure += beyond * result.slope + more.pressure;
    result.slope += more.slope;
  }
  return result;
}

LayerPressure LayerLaw::guardAt(double distance) const {
  if (distance < kTouching) return {guardAt(kTouching).energy, 0.0, 0.0};
  if (!(distance < least_)) return {0.0, 0.0, 0.0};
  return barrier(distance, material::kKesHighPressure / least_);
}

/// @param distance below the least one @param factor c, Pa/m
LayerPressure LayerLaw::barrier(double distance, double factor) const {
  const double short_of = least_ - distance;
  const double log = std::log(least_ / distance);
  const double ratio = short_of / distance;
  return {factor * short_of * short_of * log, factor * short_of * (2.0 * log + ratio),
          factor * (2.0 * log + 4.0 * ratio + ratio * ratio)};
}

}  // namespace haptex::cloth
