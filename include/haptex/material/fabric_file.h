// Fabric files: YAML, one fabric each.
#pragma once

#include <string>

#include "haptex/material/fabric.h"

namespace haptex::material {

/// Reads a fabric file; docs/fabric_files.md describes the format.
/// @throws std::runtime_error if the file cannot be read or is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed if a key is missing
///   or unknown, a unit is wrong, a number is not finite or out of range, samples are not in
///   strictly increasing order of strain, a curve pushes where it should pull back: a stress
///   against its strain, or a falling end, with which the curve would continue; or what
///   compressionFromPoints() and compressionFromKes() refuse
Fabric loadFabric(const std::string& path);

/// The same of the text of a fabric file.
/// @param name of it in messages; paths in the text are taken from its directory
Fabric parseFabric(const std::string& text, const std::string& name);

}  // namespace haptex::material
