#include "haptex/material/linear_fabric.h"

namespace haptex::material {

Fabric linearFabric(double modulus, double viscosity) {
  Fabric fabric;
  fabric.name = "linear";
  fabric.areal_density = 0.1;
  fabric.weft.elastic = fabric.warp.elastic = StrainStressCurve::linear(modulus);
  fabric.shear.elastic = StrainStressCurve::linear(0.5 * modulus);
  fabric.weft.viscous = fabric.warp.viscous = StrainStressCurve::linear(viscosity);
  fabric.shear.viscous = StrainStressCurve::linear(0.5 * viscosity);
  fabric.friction = 0.3;
  return fabric;
}

}  // namespace haptex::material
