// The fabric of a scene, against what the scene lists.
#pragma once

#include <string>

#include "haptex/cloth/scene.h"
#include "haptex/material/fabric.h"

namespace haptex::contact {

/// Reads the fabric of a scene.
/// @param scene_path of the scene's file, for its key haptics and for messages
/// @throws std::exception what material::loadFabric() and loadHapticSettings() throw
/// @throws std::invalid_argument if the scene lists fingers, or tactile, and the fabric lacks what
///   they need; the message names both
material::Fabric loadSceneFabric(const std::string& scene_path, const cloth::Scene& scene);

}  // namespace haptex::contact
