// How a step in time is taken, as scene files and quality files say it.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/cloth/dynamics/step_length_control.h"

namespace haptex::scene {

constexpr double kShortestTimeStep = 1e-6;  ///< s
constexpr double kLongestTimeStep = 10.0;   ///< s

/// A time step (s), from 1e-6 to 10.
/// @throws std::invalid_argument naming file, key, value and what is allowed
double readTimeStep(const base::YamlValue& value);

/// {from, to, error}: time steps (s), the first not longer than the second, and the error of a
/// particle's place in a step (m), > 0 and at most 1.
/// @throws std::invalid_argument naming file, key, value and what is allowed
cloth::AdaptiveSteps readAdaptiveSteps(const base::YamlValue& map);

/// What the keys integrator and solver of a map say, both optional.
/// @throws std::invalid_argument naming file, key, value and what is allowed
cloth::StepSettings readStepSettings(const base::YamlValue& map);

}  // namespace haptex::scene
