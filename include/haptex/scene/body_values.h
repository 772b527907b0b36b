// What a scene says about obstacles with mass and about penalty, against the rest of it.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/scene/scene.h"

namespace haptex::scene {

/// Obstacles with mass need what moves them, and nothing beside them that does not know them.
/// @param scene its obstacles, effects and step read
/// @throws std::invalid_argument naming file, key and what is allowed
void requireBodiesKnown(const base::YamlValue& file, const Scene& scene);

/// The value of the key penalty (N/m). @param scene as above
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readPenalty(const base::YamlValue& file, const Scene& scene);

}  // namespace haptex::scene
