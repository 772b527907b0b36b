#include "haptex/material/fabric_factors.h"

#include <array>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::material {
namespace {

using Named = std::pair<const char*, double>;

std::array<Named, 5> namedFactors(const FabricFactors& factors) {
  return {Named{"weft", factors.weft}, Named{"warp", factors.warp}, Named{"shear", factors.shear},
          Named{"bending", factors.bending}, Named{"density", factors.density}};
}

void scale(double factor, MembraneCurves& curves) {
  if (factor == 1.0) return;
  curves.elastic = curves.elastic.scaledBy(factor);
  curves.viscous = curves.viscous.scaledBy(factor);
}

}  // namespace

bool FabricFactors::operator==(const FabricFactors& other) const {
  return namedFactors(*this) == namedFactors(other);
}

void requireSound(const FabricFactors& factors) {
  for (const auto& [name, factor] : namedFactors(factors)) {
    if (factor >= FabricFactors::kLeast && factor <= FabricFactors::kMost) continue;
    base::refuse("the factor of ", name, " = ", factor, ": allowed are ", FabricFactors::kLeast,
                 " to ", FabricFactors::kMost);
  }
}

Fabric scaledBy(const FabricFactors& factors, Fabric fabric) {
  requireSound(factors);
  scale(factors.weft, fabric.weft);
  scale(factors.warp, fabric.warp);
  scale(factors.shear, fabric.shear);
  if (fabric.shear_hysteresis) {
    fabric.shear_hysteresis->at_half_degree *= factors.shear;
    fabric.shear_hysteresis->at_five_degrees *= factors.shear;
  }
  if (fabric.bending) {
    fabric.bending->weft *= factors.bending;
    fabric.bending->warp *= factors.bending;
  }
  if (fabric.bending_hysteresis) {
    fabric.bending_hysteresis->weft *= factors.bending;
    fabric.bending_hysteresis->warp *= factors.bending;
  }
  fabric.areal_density *= factors.density;
  return fabric;
}

}  // namespace haptex::material
