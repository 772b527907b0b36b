// Fabrics that are a stiffer or heavier variant of a measured one.
#pragma once

#include "haptex/material/fabric.h"

namespace haptex::material {

/// By what properties of a fabric are multiplied, no unit.
struct FabricFactors {
  static constexpr double kLeast = 0.01, kMost = 100.0;

  double weft = 1.0;     ///< stress of the weft's curves, elastic and viscous
  double warp = 1.0;     ///< of the warp's
  double shear = 1.0;    ///< of shear's, and its hysteresis
  double bending = 1.0;  ///< rigidity and hysteresis
  double density = 1.0;  ///< areal

  bool operator==(const FabricFactors& other) const;
  bool operator!=(const FabricFactors& other) const { return !(*this == other); }
};

/// @throws std::invalid_argument naming the factor unless all are from kLeast to kMost
void requireSound(const FabricFactors& factors);

/// The variant. Its name and file stay those of the fabric.
/// @throws std::invalid_argument what requireSound() says
Fabric scaledBy(const FabricFactors& factors, Fabric fabric);

}  // namespace haptex::material
