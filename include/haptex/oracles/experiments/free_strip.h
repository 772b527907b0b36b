// A strip pulled along its length with free sides, its threads at any angle: exact and simulated.
#pragma once

#include "haptex/kes/virtual_test.h"
#include "haptex/material/fabric.h"

namespace haptex::oracles {

struct Uniaxial {
  double strain;             ///< engineering, along
  double transverse_strain;  ///< engineering
  double force;              ///< per rest width, N/m
};

/// Along weft or warp, with the transverse contraction of the fabric: solves fv(ev) + c eu = 0 for
/// the transverse strain by bisection.
/// @param fabric whose curves rise
/// @param strain engineering, > -1 and so small that the width stays > 0; that is, if the fabric
///   contracts, that c eu < -fv(-1/2)
/// @throws std::invalid_argument naming a strain out of this range
Uniaxial exactUniaxial(const material::Fabric& fabric, kes::Direction direction, double strain);

/// A strip of 100 x 20 mm whose ends are loaded and nothing else is held: the strains that follow.
/// @param force N/m
Uniaxial simulateUniaxial(const material::Fabric& fabric, kes::Direction direction, double force);

}  // namespace haptex::oracles
