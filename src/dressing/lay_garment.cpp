#include "haptex/dressing/lay_garment.h"

#include <filesystem>
#include <utility>

#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/outfit.h"
#include "haptex/mesh/obj_file.h"

namespace haptex::dressing {

LaidGarment layGarment(const std::string& garment, const std::string& body, double edge_length) {
  const garment::Pattern pattern = garment::loadOutfit(garment);
  if (std::filesystem::path(body).extension() != ".yaml") {
    mesh::ObstacleMesh surface = mesh::loadObjSurface(body);
    return {garment::makeGarmentMesh(pattern, edge_length), std::move(surface)};
  }
  const garment::Body figure = garment::loadBody(body);
  return {garment::makeGarmentMesh(pattern, edge_length, figure),
          {figure.vertices, figure.triangles}};
}

}  // namespace haptex::dressing
