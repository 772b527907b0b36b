// What a fabric file says of one fabric that is not glued of others.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/material/fabric.h"

namespace haptex::material {

/// @param values as docs/fabric_files.md describes them; paths are taken from the file's directory
/// @throws std::invalid_argument what loadFabric() says
Fabric readFabricValues(const base::YamlValue& values);

}  // namespace haptex::material
