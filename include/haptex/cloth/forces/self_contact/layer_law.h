// What two layers of a fabric do to each other through their thickness.
#pragma once

#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// At one distance of the middle surfaces of two layers.
struct LayerPressure {
  double energy;    ///< J/m^2, of both layers
  double pressure;  ///< Pa, its negative derivative by the distance, >= 0
  double slope;     ///< Pa/m, the negative derivative of the pressure, >= 0
};

/// Pressure against the distance of the middle surfaces of two layers that lie on each other: that
/// of the fabric's compression curve at a thickness equal to the distance. Zero from the thickness
/// without pressure on. The curve ends where KES does, at kKesHighPressure; nearer than this least
/// distance the pressure goes on with the slope c that it has there, and with
///   energy += c (d - least)^2 ln(least / d),
/// a logarithmic barrier, which is C2 and does not let the distance vanish (Li et al., Incremental
/// Potential Contact, ACM Trans. Graphics 39(4), 2020).
class LayerLaw {
 public:
  /// @throws std::invalid_argument if the fabric has no compression
  explicit LayerLaw(const material::Fabric& fabric);

  /// m: what is nearer than this touches. Rounding then decides on which side of each other two
  /// layers are, so the energy stays what it is there, without pressure. Only starts are so near.
  static constexpr double kTouching = 1e-9;

  /// @param distance m, >= 0
  LayerPressure at(double distance) const;
  /// A guard for places that touch without layers lying on each other, two edges that cross: zero
  /// from the least distance on, and then the barrier with a c of kKesHighPressure / least
  /// distance.
  /// @param distance m, >= 0
  LayerPressure guardAt(double distance) const;

  double thickness() const { return compression_.thickness; }  ///< m, without pressure
  double leastDistance() const { return least_; }              ///< m, see above
  /// m, half way between the two: where the pressure is still small.
  double margin() const { return 0.5 * (thickness() + least_); }

 private:
  LayerPressure barrier(double distance, double factor) const;

  material::Compression compression_;
  double least_;
};

}  // namespace haptex::cloth
