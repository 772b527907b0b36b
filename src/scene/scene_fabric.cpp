#include "haptex/scene/scene_fabric.h"

#include <stdexcept>

#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/material/fabric_file.h"

namespace haptex::scene {

material::Fabric loadSceneFabric(const std::string& scene_path, const Scene& scene) {
  material::Fabric fabric = material::loadFabric(scene.fabric_path);
  if (!scene.fingers) return fabric;
  const contact::HapticSettings settings = contact::loadHapticSettings(scene_path);
  try {
    contact::requireTouchable(fabric, settings);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(scene_path + ": model: lists fingers, but " + error.what());
  }
  if (scene.tactile && !fabric.surface) {
    throw std::invalid_argument(scene_path + ": model: lists tactile, but fabric '" + fabric.name +
                                "' has no surface: " + scene.fabric_path +
                                " needs the key surface");
  }
  return fabric;
}

}  // namespace haptex::scene
