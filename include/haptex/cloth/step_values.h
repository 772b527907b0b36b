// How a step in time is taken, as scene files and quality files say it.
#pragma once

#include "haptex/cloth/step.h"
#include "haptex/material/yaml_reader.h"

namespace haptex::cloth {

/// A time step (s), from 1e-6 to 10.
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readTimeStep(const material::YamlValue& value);

/// What the keys integrator and solver of a map say, both optional.
/// @throws std::invalid_argument naming file, key, value and what is allowed
StepSettings readStepSettings(const material::YamlValue& map);

}  // namespace haptex::cloth
