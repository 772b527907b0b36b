// The list of obstacles in a scene file.
#pragma once

#include <vector>

#include "haptex/cloth/obstacle.h"
#include "haptex/material/yaml_reader.h"

namespace haptex::cloth {

/// Reads the value of the key `obstacles`; docs/scene_files.md describes it.
/// @throws std::runtime_error if the file of a mesh cannot be read
/// @throws std::invalid_argument naming file, key, value and what is allowed, or what
/// loadObjSurface() says
std::vector<Obstacle> readObstacles(const material::YamlValue& list);

}  // namespace haptex::cloth
