// The section `surface` of a fabric file.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/material/surface.h"

namespace haptex::material {

/// Reads KES values and relief; docs/fabric_files.md describes the format. The path of a file of
/// heights is taken from the directory of the fabric file. The file itself is not opened.
/// @param friction KES MIU of the fabric, > 0: MMD is the deviation from it
/// @throws std::invalid_argument naming file, key, value and what is allowed: one relief, numbers
///   finite and in the ranges of haptex/material/surface.h
Surface readSurface(const base::YamlValue& value, double friction);

}  // namespace haptex::material
