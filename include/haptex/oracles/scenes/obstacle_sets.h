// Cloth that collides with itself, on and through obstacles.
#pragma once

#include <vector>

#include "haptex/oracles/scenes/self_colliding_cloth.h"

namespace haptex::oracles {

/// - box_edge: a sheet is thrown at 2 m/s on an edge of a box,
/// - needle: likewise on the tip of an upright needle, 1 mm thick,
/// - edges_and_needles: a towel falls on two edges, six needles and a floor,
/// - funnel: a sheet is drawn by its middle through an open funnel,
/// - rotating_sphere: a sheet falls on a sphere that turns on a floor.
/// @param cells along 100 mm, > 0
std::vector<SelfCollidingCloth::Set> obstacleSets(int cells);

}  // namespace haptex::oracles
