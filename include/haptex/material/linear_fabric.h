// The fabric of the cases whose exact results are known.
#pragma once

#include "haptex/material/fabric.h"

namespace haptex::material {

/// 0.1 kg/m2, linear, without bending; friction 0.3.
/// @param modulus N/m along the threads, half of it in shear @param viscosity N.s/m, likewise
Fabric linearFabric(double modulus, double viscosity = 0.0);

}  // namespace haptex::material
