// The fabric that the large-scale layer sends in cloth/mesh.
#pragma once

#include <haptex/ClothMesh.h>

#include <cstddef>

#include "haptex/material/fabric.h"

namespace haptex::nodes {

constexpr std::size_t kLongestFabricFile = 1000000;  ///< bytes
constexpr std::size_t kLongestFabricName = 200;      ///< bytes

/// Reads the fabric from the text in the message, and no file.
/// @throws std::exception naming the fabric and what is wrong with it: not one name and one text,
///   one that is longer than the above, that is not a fabric file, or is one of another fabric
material::Fabric fabricOfCloth(const haptex::ClothMesh& message);

}  // namespace haptex::nodes
