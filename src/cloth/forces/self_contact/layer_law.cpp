#include "haptex/cloth/forces/self_contact/layer_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptex/material/compression.h"

namespace haptex::cloth {
namespace {

// Of the thickness without pressure; a curve that goes on to less ends there.
constexpr double kLeastRatio = 0.05;

const material::Compression& requireCompression(const material::Fabric& fabric) {
  if (fabric.compression) return *fabric.compression;
  throw std::invalid_argument("self_collision is modelled and fabric '" + fabric.name +
                              "' has no thickness: add the key compression");
}

}  // namespace

LayerLaw::LayerLaw(const material::Fabric& fabric)
    : compression_(requireCompression(fabric)),
      least_(compression_.thickness *
             std::max(kLeastRatio, 1.0 - compression_.pressure.lastKnot())) {}

LayerPressure LayerLaw::at(double distance) const {
  const double thickness = compression_.thickness;
  if (!(distance < thickness)) return {0.0, 0.0, 0.0};
  const double strain = (thickness - distance) / thickness;
  const material::CurveValue curve = compression_.pressure.evaluate(strain);
  LayerPressure result = {thickness * compression_.pressure.energy(strain), curve.stress,
                          curve.slope / thickness};
  if (distance < least_) {
    const LayerPressure more = barrier(distance, result.slope);
    result.energy += more.energy;
    result.pressure += more.pressure;
    result.slope += more.slope;
  }
  return result;
}

LayerPressure LayerLaw::guardAt(double distance) const {
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
