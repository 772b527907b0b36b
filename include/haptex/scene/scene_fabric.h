// The fabrics of a scene, against what the scene lists.
#pragma once

#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"

namespace haptex::scene {

/// Reads the fabrics of a scene: first that of the cloth, then those of its regions, as its
/// triangles name them.
/// @param scene_path of the scene's file, for its key haptics and for messages
/// @throws std::exception what material::loadFabric() and loadHapticSettings() throw
/// @throws std::invalid_argument if the scene lists fingers, or tactile, and a fabric lacks what
///   they need; the message names both
std::vector<material::Fabric> loadSceneFabrics(const std::string& scene_path, const Scene& scene);

}  // namespace haptex::scene
