// What a scene says about obstacles with mass and about penalty, against the rest of it.
#pragma once

#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::scene {

/// Obstacles with mass need what moves them, and nothing beside them that does not know them.
/// @throws std::invalid_argument naming file, key and what is allowed
void requireBodiesKnown(const base::YamlValue& file, const std::vector<mesh::Obstacle>& obstacles,
                        const cloth::ModelledEffects& effects, cloth::IntegrationMethod method);

/// The value of the key penalty (N/m).
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readPenalty(const base::YamlValue& file, const cloth::ModelledEffects& effects,
                   cloth::IntegrationMethod method);

}  // namespace haptex::scene
