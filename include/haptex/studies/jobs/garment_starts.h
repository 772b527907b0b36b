// Garments from starts that nobody has chosen.
#pragma once

#include <string>
#include <vector>

#include "haptex/dressing/drape.h"
#include "haptex/dressing/lay_garment.h"
#include "haptex/material/fabric.h"

namespace haptex::studies {

/// A garment that the package ships, and how far disturb() moves its panels.
struct GarmentScene {
  const char* garment;  ///< config/garments/GARMENT.yaml
  const char* body;     ///< a file of config
  double shift;         ///< m
  double turn;          ///< rad
  double edge;          ///< m, of the triangles
};
/// Panels that lie on carriers, 4 mm beside each other, are moved less.
const std::vector<GarmentScene>& garmentScenes();

/// What dressing::drape() is given.
struct GarmentStart {
  dressing::LaidGarment laid;
  std::vector<material::Fabric> fabrics;
  dressing::DrapeSettings settings;
};

/// @param config the directory of the package's files
/// @throws what dressing::layGarment() and material::loadFabric() throw
GarmentStart startOf(const GarmentScene& scene, const std::string& config);

/// Moves the panels of a garment that is not sewn yet: each about its middle by a vector of up to
/// scene.shift and an angle of up to scene.turn in every direction. Draws again until nothing
/// intersects, with itself or with the body.
/// @param seed the same one moves them alike
/// @throws std::runtime_error if 100 draws intersect
void disturb(mesh::ClothMesh& mesh, const mesh::ObstacleMesh& body, const GarmentScene& scene,
             unsigned seed);

}  // namespace haptex::studies
