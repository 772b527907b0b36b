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

double requireFriction(const material::Fabric& fabric) {
  if (fabric.friction) return *fabric.friction;
  throw std::invalid_argument("self_collision is modelled and fabric " + base::quoted(fabric.name) +
                              " has no friction: add the key friction");
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

/// @param distance below the least one @param factor c, Pa/m
LayerPressure barrier(double least, double distance, double factor) {
  const double short_of = least - distance;
  const double log = std::log(least / distance);
  const double ratio = short_of / distance;
  return {factor * short_of * short_of * log, factor * short_of * (2.0 * log + ratio),
          factor * (2.0 * log + 4.0 * ratio + ratio * ratio)};
}

LayerPressure guard(double least, double distance) {
  if (distance < LayerLaw::kTouching) {
    return {guard(least, LayerLaw::kTouching).energy, 0.0, 0.0};
  }
  if (!(distance < least)) return {0.0, 0.0, 0.0};
  return barrier(least, distance, material::kKesHighPressure / least);
}

}  // namespace

LayerLaw::LayerLaw(const material::Fabric& fabric)
    : compression_(requireCompression(fabric)),
      least_(compression_.thickness * (1.0 - lastStrain(compression_.pressure))) {}

LayerPressure LayerLaw::at(double distance) const {
  if (distance < kTouching) return {pressed(kTouching).energy, 0.0, 0.0};
  return pressed(distance);
}

/// @param distance m, > 0
LayerPressure LayerLaw::pressed(double distance) const {
  const double thickness = compression_.thickness;
  if (!(distance < thickness)) return {0.0, 0.0, 0.0};
  const double strain = (thickness - std::max(distance, least_)) / thickness;
  const material::CurveValue curve = compression_.pressure.evaluate(strain);
  LayerPressure result = {thickness * compression_.pressure.energy(strain), curve.stress,
                          curve.slope / thickness};
  if (distance < least_) {
    const LayerPressure more = barrier(least_, distance, result.slope);
    const double beyond = least_ - distance;
    result.energy += beyond * (result.pressure + 0.5 * beyond * result.slope) + more.energy;
    result.pressure += beyond * result.slope + more.pressure;
    result.slope += more.slope;
  }
  return result;
}

LayerPressure LayerLaw::guardAt(double distance) const { return guard(least_, distance); }

LayerPressure LayerPair::at(double distance) const {
  if (&first_ == &second_) return first_.at(distance);
  if (distance < LayerLaw::kTouching) return {inSeries(LayerLaw::kTouching).energy, 0.0, 0.0};
  return inSeries(distance);
}

/// Newton's method within a bracket. What the first is short of in pressure falls with its share of
/// the distance; the forces miss what is left over of that, the energy its square.
LayerPressure LayerPair::inSeries(double distance) const {
  if (!(distance < thickness())) return {0.0, 0.0, 0.0};
  constexpr int kMost = 100;
  constexpr double kEnough = 1e-14;  // of the distance
  const double both = 2.0 * distance;
  double low = std::max(0.0, both - second_.thickness());
  double high = std::min(both, first_.thickness());
  double share = std::clamp(distance * first_.thickness() / thickness(), low, high);
  LayerPressure first{}, second{};
  for (int i = 0; i < kMost; ++i) {
    first = first_.pressed(share);
    second = second_.pressed(both - share);
    const double missing = first.pressure - second.pressure;
    (missing > 0.0 ? low : high) = share;
    double next = share + missing / (first.slope + second.slope);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (missing == 0.0 || std::abs(next - share) <= kEnough * distance) break;
    share = next;
  }
  const double slopes = first.slope + second.slope;
  return {0.5 * (first.energy + second.energy), 0.5 * (first.pressure + second.pressure),
          slopes > 0.0 ? 2.0 * first.slope * second.slope / slopes : 0.0};
}

LayerPressure LayerPair::guardAt(double distance) const { return guard(leastDistance(), distance); }

FabricLayers::FabricLayers(const std::vector<material::Fabric>& fabrics) {
  for (const material::Fabric& fabric : fabrics) {
    friction_.push_back(requireFriction(fabric));
    laws_.emplace_back(fabric);
    thickness_ = std::max(thickness_, laws_.back().thickness());
    least_ = std::max(least_, laws_.back().leastDistance());
  }
}

double FabricLayers::friction(int first, int second) const {
  if (first == second) return friction_[first];
  return std::sqrt(friction_[first] * friction_[second]);
}

}  // namespace haptex::cloth
