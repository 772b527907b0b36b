// Where the cloth was, from a bag.
#pragma once

#include <haptex/ClothState.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace haptex::nodes {

using Triangles = std::vector<std::array<int, 3>>;  // particle indices

/// Hands on every state of the only topic of haptex/ClothState in the bag whose name ends in
/// cloth/state, in the order of the bag, and the triangles of the only topic of haptex/ClothMesh
/// whose name ends in cloth/mesh.
/// @throws std::runtime_error naming the bag if it cannot be read, std::invalid_argument naming the
///   topics in the bag if none or more than one is meant, or saying that there is no message, or
///   that the triangles change
void readClothRecording(const std::string& bag,
                        const std::function<void(const ClothState&, const Triangles&)>& visit);

}  // namespace haptex::nodes
