// Makes the small-scale layer for what cloth/mesh says.
#pragma once

#include <haptex/ClothMesh.h>

#include <memory>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::nodes {

class LayerBuilder {
 public:
  /// @param scene_path the scene of the large-scale layer, for its effects and obstacles, and how
  ///   the small-scale layer is computed
  /// @throws std::exception what scene::loadScene() and contact::loadHapticSettings() throw
  explicit LayerBuilder(const std::string& scene_path);

  const contact::HapticSettings& settings() const { return settings_; }

  /// Fabrics and gravity are those of the message.
  /// @throws std::exception naming what was wrong with the mesh or the fabric
  std::unique_ptr<contact::HapticLayer> build(const haptex::ClothMesh& message) const;

 private:
  contact::HapticSettings settings_;
  cloth::ModelledEffects effects_;
  std::vector<mesh::Obstacle> obstacles_;
};

}  // namespace haptex::nodes
