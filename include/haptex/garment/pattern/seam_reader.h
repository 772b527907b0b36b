// What garment files and the sidecars of DXF files say about seams.
#pragma once

#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// Adds the seams of a list `seams` and the darts of a list `darts` to a pattern that has panels.
/// @param file with one, both or none of these keys
/// @throws std::invalid_argument naming file and key, value and what is allowed
void readSeams(const base::YamlValue& file, Pattern& pattern);

/// Adds the places to fasten of a list `fasteners`, if there is one, likewise.
/// @throws std::invalid_argument naming file and key, value and what is allowed
void readFastenings(const base::YamlValue& file, Pattern& pattern);

}  // namespace haptex::garment
