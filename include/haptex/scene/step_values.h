// How a step in time is taken, as scene files and quality files say it.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/dynamics/step.h"

namespace haptex::scene {

/// A time step (s), from 1e-6 to 10.
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readTimeStep(const base::YamlValue& value);

/// What the keys integrator and solver of a map say, both optional.
/// @throws std::invalid_argument naming file, key, value and what is allowed
cloth::StepSettings readStepSettings(const base::YamlValue& map);

}  // namespace haptex::scene
