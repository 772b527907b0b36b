// The fabric of a scene, against what the scene lists.
#pragma once

#include <string>

#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"

namespace haptex::scene {

/// Reads the fabric of a scene.
/// @param scene_path of the scene's file, for its key haptics and for messages
/// @throws std::exception what material::loadFabric() and loadHapticSettings() throw
/// @throws std::invalid_argument if the scene lists fingers, or tactile, and the fabric lacks what
///   they need; the message names both
material::Fabric loadSceneFabric(const std::string& scene_path, const Scene& scene);

}  // namespace haptex::scene
