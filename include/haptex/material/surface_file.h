// The sections `surface` and `look` of a fabric file.
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

/// Reads the colours of the yarns and their highlight.
/// @param knitted whether the fabric has a relief `knit`
/// @throws std::invalid_argument naming file, key, value and what is allowed: colours of three
///   numbers from 0 to 1, of a knit twice the same, gloss from 0 to 1, width > 0 and at most 1
Look readLook(const base::YamlValue& value, bool knitted);

}  // namespace haptex::material
