// Measures on this machine what a quality takes for a cloth.
#pragma once

#include <string>

#include "haptex/material/fabric.h"
#include "haptex/scene/quality.h"
#include "haptex/simulation/quality_choice.h"

namespace haptex::simulation {

/// Moves the cloth of a scene, with the cells of the quality if it may have any, for a few cycles.
/// @param substeps in a cycle, > 0
/// @returns the median time of a cycle, infinity if a step was not finite, and the time of it all
/// @throws what scene::loadScene() and SimulatedCloth throw
MeasuredCycle measureCycle(const std::string& scene_path,
                           const std::vector<material::Fabric>& fabrics,
                           const scene::Quality& quality, int substeps);

}  // namespace haptex::simulation
