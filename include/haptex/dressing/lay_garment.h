// A garment before it is sewn, laid on the body that wears it.
#pragma once

#include <string>

#include "haptex/garment/garment_mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::dressing {

/// Panels as they lie before they are sewn, and what they are sewn around.
struct LaidGarment {
  garment::GarmentMesh garment;
  mesh::ObstacleMesh body;  ///< its surface, m, world frame
};

/// Lays the panels of a garment where its file places them, or around the body where it lays them
/// on carriers.
/// @param garment     a garment file, or one that lists several
/// @param body        a body file (`.yaml`), or an OBJ file, which knows no carriers
/// @param edge_length m, > 0, of the triangles
/// @throws std::invalid_argument what garment::loadOutfit(), garment::loadBody(),
///   mesh::loadObjSurface() and garment::makeGarmentMesh() say
LaidGarment layGarment(const std::string& garment, const std::string& body, double edge_length);

}  // namespace haptex::dressing
