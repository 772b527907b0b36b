// The surface of a fabric, ready to be stroked.
#pragma once

#include <string>

#include "haptex/material/fabric.h"
#include "haptex/tactile/amplitude_map.h"
#include "haptex/tactile/stroke.h"

namespace haptex::tactile {

struct Surface {
  std::string fabric;  ///< its name
  SmallScale small_scale;
  AmplitudeMap large_scale;
};

/// Small and large scale of the relief in fabric.surface, scaled so that the virtual KES tester of
/// haptex/tactile/kes_surface.h finds its SMD and its MMD.
/// @throws std::invalid_argument if the fabric has no surface or its relief is flat, and what
///   loadHeights() throws for a relief in a file
Surface buildSurface(const material::Fabric& fabric);

}  // namespace haptex::tactile
