// What the cloth under the fingertips takes, and what its surface takes.
#pragma once

#include <cstddef>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::simulation {

/// Of a millisecond with two fingertips, of which each presses 1 mm into a place of the cloth.
struct TouchCost {
  double far_seconds = 0.0;       ///< computing time, median: no fingertip is near
  double near_seconds = 0.0;      ///< likewise: both touch
  std::size_t far_particles = 0;  ///< of the patches
  std::size_t near_particles = 0;
};

/// @param mesh in its initial positions
/// @throws std::invalid_argument what contact::HapticLayer throws
TouchCost measureTouch(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                       const cloth::ModelledEffects& effects,
                       const contact::HapticSettings& settings, int milliseconds);

/// Computing time (s), median, of the amplitudes of both arrays for 25 ms while they rub.
/// @param fabric with a surface
/// @throws std::exception what tactile::buildSurface() throws
double measureTactile(const material::Fabric& fabric, int steps);

}  // namespace haptex::simulation
