// The fabrics that the large-scale layer sends in cloth/mesh.
#pragma once

#include <haptex/ClothMesh.h>

#include <cstddef>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::nodes {

constexpr std::size_t kLongestFabricFile = base::kLargestYaml;  ///< bytes
constexpr std::size_t kLongestFabricName = 200;                 ///< bytes

/// Reads the fabrics from the texts in the message, and no file.
/// @throws std::exception naming the fabric and what is wrong with it: no text for each name, none
///   or more than mesh::kMostFabrics, one that is longer than the above, that is not a fabric file,
///   or is one of another fabric
std::vector<material::Fabric> fabricsOfCloth(const haptex::ClothMesh& message);

/// One of them, likewise. @param index less than the number of names
material::Fabric fabricOfCloth(const haptex::ClothMesh& message, std::size_t index);
/// @throws std::invalid_argument if there are not as many texts as names, none or too many
void requireFabrics(const haptex::ClothMesh& message);

}  // namespace haptex::nodes
