#include "haptex/nodes/common/cloth_fabric.h"

#include <stdexcept>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"

namespace haptex::nodes {

FabricOfFile fabricOfCloth(const std::string& name, const std::string& scene_fabric) {
  if (!scene_fabric.empty()) {
    FabricOfFile of_scene{material::loadFabric(scene_fabric), scene_fabric};
    if (of_scene.fabric.name == name) return of_scene;
  }
  if (name.find('/') != std::string::npos) {
    throw std::invalid_argument("allowed is the name of a fabric in config/fabrics, not a path");
  }
  const std::string path = findConfigFile("fabrics", name);
  FabricOfFile of_package{material::loadFabric(path), path};
  if (of_package.fabric.name != name) {
    throw std::invalid_argument("the file of this name is of the fabric '" +
                                of_package.fabric.name + "'");
  }
  return of_package;
}

}  // namespace haptex::nodes
