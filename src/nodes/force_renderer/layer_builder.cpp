#include "haptex/nodes/force_renderer/layer_builder.h"

#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/cloth_fabric.h"
#include "haptex/nodes/force_renderer/renderer_messages.h"
#include "haptex/scene/scene.h"

namespace haptex::nodes {

LayerBuilder::LayerBuilder(const std::string& scene_path)
    : settings_(contact::loadHapticSettings(scene_path)) {
  const scene::Scene scene = scene::loadScene(scene_path);
  effects_ = scene.effects;
  obstacles_ = scene.obstacles;
}

std::unique_ptr<contact::HapticLayer> LayerBuilder::build(const haptex::ClothMesh& message) const {
  mesh::ClothMesh mesh = clothMesh(message);
  std::vector<material::Fabric> fabrics = fabricsOfCloth(message);
  const std::string name = fabrics.front().name;
  cloth::ModelledEffects effects = effects_;
  effects.gravity = readGravity(message);
  try {
    return std::make_unique<contact::HapticLayer>(std::move(mesh), std::move(fabrics), effects,
                                                  settings_, obstacles_);
  } catch (const std::exception& error) {
    throw std::invalid_argument("fabric " + base::quoted(name) + ": " + error.what());
  }
}

}  // namespace haptex::nodes
