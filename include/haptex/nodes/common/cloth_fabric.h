// The fabric that the large-scale layer names in cloth/mesh.
#pragma once

#include <string>

#include "haptex/material/fabric.h"

namespace haptex::nodes {

/// A fabric and the file that it was read from.
struct FabricOfFile {
  material::Fabric fabric;
  std::string path;
};

/// The scene's fabric if it has this name, otherwise the package's of this name.
/// @param scene_fabric path of the fabric file of the scene; empty without a scene
/// @throws std::exception naming what was wrong with the name or the file; a path is no name
FabricOfFile fabricOfCloth(const std::string& name, const std::string& scene_fabric);

}  // namespace haptex::nodes
