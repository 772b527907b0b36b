// What two layers of fabric do to each other through their thickness.
#pragma once

#include <vector>

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
  friend class LayerPair;
  LayerPressure pressed(double distance) const;

  material::Compression compression_;
  double least_;
};

/// A layer of one fabric on a layer of another, as two springs in series: both have the same
/// pressure p, and the middle surfaces are half of the thickness that either fabric has under it
/// apart,
///   d(p) = (d_first(p) + d_second(p)) / 2.
/// So all thicknesses are sums of halves. Of twice the same fabric it is the fabric's LayerLaw.
class LayerPair {
 public:
  /// Both have to outlive this.
  LayerPair(const LayerLaw& first, const LayerLaw& second) : first_(first), second_(second) {}

  /// As LayerLaw has them.
  LayerPressure at(double distance) const;
  LayerPressure guardAt(double distance) const;
  double thickness() const { return 0.5 * (first_.thickness() + second_.thickness()); }
  double leastDistance() const { return 0.5 * (first_.leastDistance() + second_.leastDistance()); }

 private:
  LayerPressure inSeries(double distance) const;

  const LayerLaw& first_;
  const LayerLaw& second_;
};

/// The layers of all fabrics of a cloth, and Coulomb friction between them.
class FabricLayers {
 public:
  /// @throws std::invalid_argument if a fabric has no compression or no friction
  explicit FabricLayers(const std::vector<material::Fabric>& fabrics);

  const LayerLaw& law(int fabric) const { return laws_[fabric]; }
  LayerPair pair(int first, int second) const { return {laws_[first], laws_[second]}; }
  /// m, that the thickest layers are apart without pressure.
  double thickness() const { return thickness_; }
  /// m, likewise the largest LayerLaw::leastDistance().
  double leastDistance() const { return least_; }
  /// The fabric's MIU, of two fabrics their geometric mean: no friction on what has none, and that
  /// of both where they are alike.
  double friction(int first, int second) const;
  int count() const { return static_cast<int>(laws_.size()); }

 private:
  std::vector<LayerLaw> laws_;
  std::vector<double> friction_;
  double thickness_ = 0.0, least_ = 0.0;
};

}  // namespace haptex::cloth
