#include "haptex/nodes/layer_builder.h"

#include <stdexcept>

#include "haptex/cloth/scene.h"
#include "haptex/nodes/cloth_fabric.h"
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
    return std::make_unique<contact::HapticLayer>(
        std::move(mesh), fabricOfCloth(message.fabric, fabric_path_).fabric, effects_, settings_);
  } catch (const std::exception& error) {
    throw std::invalid_argument("fabric '" + message.fabric + "': " + error.what());
  }
}

}  // namespace haptex::nodes
