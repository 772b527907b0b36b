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

/// With linear curves at any angle of the threads: the stress is s n n^T with the strip's direction
/// n in the threads' axes, strains follow from it by the moduli (slopes at zero), contraction
/// included, and the force per rest width is s times the stretch along n.
/// @param along  the strip's length in its rest coordinates
/// @param grain  rad, from the axes of the rest coordinates to weft and warp of the fabric
/// @param stress N/m, s, second Piola-Kirchhoff, so small that no stretch vanishes
/// @throws std::invalid_argument naming a stress at which one does, or a fabric that does not
/// resist
Uniaxial exactObliqueUniaxial(const material::Fabric& fabric, kes::Direction along, double grain,
                              double stress);

/// A strip of 100 x 20 mm; its length is weft or warp of the rest coordinates, from which the
/// threads are turned by the grain.
struct FreeStrip {
  material::Fabric fabric;
  kes::Direction along = kes::Direction::kWeft;
  double grain = 0.0;                      ///< rad
  int cells_along = 20, cells_across = 4;  ///< even
  unsigned seed = 2;                       ///< of the irregular mesh
};
/// The ends are loaded and nothing is held: the strains that follow. @param force N/m
Uniaxial simulateUniaxial(const FreeStrip& strip, double force);

}  // namespace haptex::oracles
