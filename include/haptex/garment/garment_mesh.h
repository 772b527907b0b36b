// A garment as one mesh of panels, and what is to be sewn to what.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/body/body.h"
#include "haptex/garment/pattern/pattern.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/seam.h"

namespace haptex::garment {

struct GarmentMesh {
  Pattern pattern;  ///< that it is made of
  /// All panels, one after the other, as they lie before they are sewn (m, world frame), with no
  /// particle in common. `panels` are those of the pattern, in its order.
  mesh::ClothMesh mesh;
  /// Particles of `mesh` along the outlines: per panel, outline and edge.
  std::vector<std::vector<std::vector<EdgeParticles>>> edges;
  std::vector<mesh::Seam> seams;     ///< of the pattern, in its order
  std::vector<std::string> fabrics;  ///< names; Panel::fabric counts them
  std::vector<std::string> panel_names;
};

/// Triangulates all panels (triangulate()). Both sides of a seam are divided alike: where one has a
/// corner the other has a particle, and between corners both have as many even parts as the one
/// that needs more. So sides that differ in length by their easing have as many particles. Where a
/// panel is so narrow that refine() halves its outline the other side is divided, too.
/// @param edge_length m, at most so long are edges along the outline, and about so long the others
/// @throws std::invalid_argument if a panel is to be laid on a carrier, and what triangulate() says
GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length);

/// The same with panels laid around a body (preposition()), bent as their carriers are. What
/// intersects there is left as it is.
/// @throws std::invalid_argument what preposition() and triangulate() say
GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length, const Body& body);

/// The garment with edges half as long: every triangle is cut into four by the middles of its
/// edges, places along seams stay those of the pattern. Initial positions are the middles, so the
/// surface in space is the same, and intersects itself only if it did. Rest coordinates of
/// particles between two of an outline are those of its curve; where a triangle would get less than
/// half of its share of the area by that, as beside sharp corners, they are the middles.
GarmentMesh halved(const GarmentMesh& garment);

}  // namespace haptex::garment
