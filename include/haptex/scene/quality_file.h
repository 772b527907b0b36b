// Quality files: points of the front between cost and error. YAML.
#pragma once

#include <string>
#include <vector>

#include "haptex/scene/quality.h"

namespace haptex::scene {

/// Reads a quality file; docs/quality.md describes the format.
/// @returns at least one quality, in the order of the file: those for the same fabric from the
///   cheapest to the most accurate
/// @throws std::runtime_error if the file cannot be read or is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed
std::vector<Quality> loadQualities(const std::string& path);

}  // namespace haptex::scene
