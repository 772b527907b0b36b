// A place of a mesh as one of the cloth.
#pragma once

#include "haptex/cloth/forces/fasteners/fasteners.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/rest_place.h"

namespace haptex::cloth {

/// @param place in a triangle of the mesh, whose particles are the cloth's
inline ClothPlace placeIn(const mesh::ClothMesh& mesh, const mesh::RestPlace& place) {
  return {mesh.triangles[place.triangle], {place.weights[0], place.weights[1], place.weights[2]}};
}

}  // namespace haptex::cloth
