// Which particles a seam makes one.
#pragma once

#include <array>
#include <vector>

#include "haptex/mesh/seam.h"

namespace haptex::mesh {

/// Pairs of particles of both sides that are in the same places, in their order along the seam.
/// @param seam whose places are given
std::vector<std::array<int, 2>> partners(const Seam& seam);

}  // namespace haptex::mesh
