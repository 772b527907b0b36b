#include "haptex/scene/scene_fabric.h"

#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/material/fabric_file.h"

namespace haptex::scene {
namespace {

void requireTouchable(const std::string& scene_path, const Scene& scene,
                      const std::string& fabric_path, const material::Fabric& fabric) {
  const contact::HapticSettings settings = contact::loadHapticSettings(scene_path);
  try {
    contact::requireTouchable(fabric, settings);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(scene_path + ": model: lists fingers, but " + error.what());
  }
  if (scene.tactile && !fabric.surface) {
    throw std::invalid_argument(scene_path + ": model: lists tactile, but fabric " +
                                base::quoted(fabric.name) + " has no surface: " + fabric_path +
                                " needs the key surface");
  }
}

}  // namespace

std::vector<material::Fabric> loadSceneFabrics(const std::string& scene_path, const Scene& scene) {
  std::vector<std::string> paths = {scene.fabric_path};
  paths.insert(paths.end(), scene.region_fabric_paths.begin(), scene.region_fabric_paths.end());
  std::vector<material::Fabric> fabrics;
  for (const std::string& path : paths) {
    fabrics.push_back(material::loadFabric(path));
    if (scene.fingers) requireTouchable(scene_path, scene, path, fabrics.back());
  }
  return fabrics;
}

}  // namespace haptex::scene
