// Cloth that hangs from two points obliquely to its threads, with its cells cut in several ways.
#pragma once

#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/material/fabric.h"

namespace haptex::oracles {

/// How much equilibria differ that should be one.
struct CutDifference {
  double apart;   ///< m, largest distance of a particle's places
  double energy;  ///< of the energies, relative; weight counts from the points
};

/// A square of 0.2 m without viscosity hangs by a corner and by the middle of a side, which are on
/// a level and 5 % nearer to each other than they are in the sheet. Its cells are cut alternately;
/// from where that rests, the cloth comes to rest once more with all cells cut along the one
/// diagonal, along the other, and alternately.
/// @param fabric with a bending rigidity @param cells along a side, even
/// @throws std::runtime_error if an equilibrium is not reached
CutDifference differenceOfCuts(const material::Fabric& fabric, cloth::Elasticity elasticity,
                               int cells);

}  // namespace haptex::oracles
