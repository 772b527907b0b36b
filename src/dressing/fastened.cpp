#include "haptex/dressing/fastened.h"

#include <limits>
#include <optional>

#include "haptex/base/require.h"
#include "haptex/cloth/forces/fasteners/place_in.h"
#include "haptex/garment/triangulation/threads.h"
#include "haptex/mesh/rest_place.h"

namespace haptex::dressing {
namespace {

cloth::ClothPlace placeOn(const mesh::ClothMesh& mesh, const garment::Pattern& pattern,
                          const garment::PlaceOnPanel& place, const std::string& name) {
  const garment::Panel& panel = pattern.panels[place.panel];
  std::vector<int> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panelOf(t) == place.panel) triangles.push_back(static_cast<int>(t));
  }
  const std::optional<mesh::RestPlace> found =
      mesh::findRestPlace(mesh, triangles, garment::Threads(panel).restOf(place.at));
  if (!found) {
    base::refuse("fastener '", name, "': (", place.at.x(), ", ", place.at.y(),
                 ") is in no triangle of panel '", panel.name,
                 "': allowed are places that are farther from its outline, or shorter edges");
  }
  return cloth::placeIn(mesh, *found);
}

}  // namespace

std::vector<cloth::Fastener> fastened(const garment::Pattern& pattern, const mesh::ClothMesh& mesh,
                                      double stiffness) {
  std::vector<cloth::Fastener> fasteners;
  for (const garment::Fastening& fastening : pattern.fastenings) {
    cloth::Fastener& fastener = fasteners.emplace_back();
    fastener.name = fastening.name;
    for (const garment::PlaceOnPanel& place : fastening.places) {
      fastener.places.push_back(placeOn(mesh, pattern, place, fastening.name));
    }
    fastener.stiffness = stiffness;
    fastener.release_force = std::numeric_limits<double>::max();
  }
  return fasteners;
}

}  // namespace haptex::dressing
