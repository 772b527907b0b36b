// The list of obstacles in a scene file.
#pragma once

#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::scene {

/// Reads the value of the key `obstacles`; docs/scene_files.md describes it.
/// @throws std::runtime_error if the file of a mesh cannot be read
/// @throws std::invalid_argument naming file, key, value and what is allowed, or what
/// loadObjSurface() says
std::vector<mesh::Obstacle> readObstacles(const base::YamlValue& list);

}  // namespace haptex::scene
