#include "haptex/nodes/layer_builder.h"

#include <stdexcept>

#include "haptex/cloth/scene.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/config_files.h"
#include "haptex/nodes/renderer_messages.h"

namespace haptex::nodes {

LayerBuilder::LayerBuilder(const std::string& scene_path)
    : settings_(contact::loadHapticSettings(scene_path)) {
  const cloth::Scene scene = cloth::loadScene(scene_path);
  effects_ = scene.effects;
  fabric_path_ = scene.fabric_path;
}

std::unique_ptr<contact::HapticLayer> LayerBuilder::build(const haptex::ClothMesh& message) const {
  cloth::ClothMesh mesh = clothMesh(message);
  try {
    return std::make_unique<contact::HapticLayer>(std::move(mesh), fabricOf(message.fabric),
                                                  effects_, settings_);
  } catch (const std::exception& error) {
    throw std::invalid_argument("fabric '" + message.fabric + "': " + error.what());
  }
}

material::Fabric LayerBuilder::fabricOf(const std::string& name) const {
  material::Fabric fabric = material::loadFabric(fabric_path_);
  if (fabric.name == name) return fabric;
  if (name.find('/') != std::string::npos) {
    throw std::invalid_argument("allowed is the name of a fabric in config/fabrics, not a path");
  }
  fabric = material::loadFabric(findConfigFile("fabrics", name));
  if (fabric.name != name) {
    throw std::invalid_argument("the file of this name is of the fabric '" + fabric.name + "'");
  }
  return fabric;
}

}  // namespace haptex::nodes
