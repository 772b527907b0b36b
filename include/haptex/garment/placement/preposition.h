// Panels around a body, before they are sewn.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/body/body.h"
#include "haptex/garment/pattern/pattern.h"
#include "haptex/garment/placement/carrier_surface.h"
#include "haptex/garment/triangulation/panel_mesh.h"

namespace haptex::garment {

constexpr double kBodyMargin = 0.01;  ///< m, between the body and the surface around it
constexpr double kLayerGap = 0.005;   ///< m, between surfaces of successive layers
constexpr double kSeamGap = 0.004;    ///< m, between edges that are to be sewn, if it is enough

/// A panel that was laid on a carrier.
struct LaidPanel {
  int panel = 0;  ///< of the pattern
  CarrierSurface surface;
  double angle = 0.0;  ///< rad, around the segment from its front, counter-clockwise from its end
  double along = 0.0;  ///< of the segment's length, from its beginning
  /// Largest change of the length of an edge of a triangle, of its length: along the surface,
  /// which rounding alone makes, and straight, by which the edge cuts the surface's curve short.
  double surface_change = 0.0;
  double straight_change = 0.0;
  double sagitta = 0.0;  ///< m, by which the middle of an edge at most is inside of the surface
};

/// What intersects. @see proximity::intersectingTriangles()
struct Overlap {
  std::string first;   ///< a panel
  std::string second;  ///< another panel, the same, or "body"
  int pairs = 0;       ///< of triangles
};

struct Preposition {
  std::vector<LaidPanel> panels;  ///< that lie on carriers, in the order of the pattern
  std::vector<Overlap> overlaps;  ///< what could not be avoided
};

/// Lays panels on their carriers around a body, right side outwards, after Fuhrmann et al.
/// (2003), and sets the initial positions of their meshes: rest coordinates stay as they
/// are. Panels that have a position stay there.
///
/// A cylinder or cone has the axis of its segment, shifted to the middle of the body, and encloses
/// of the chain of the segment what is beside its panels, by kBodyMargin. It is wide enough for all
/// panels of a layer side by side, and for those of lower layers, in the order of the file if
/// layers are the same, by kLayerGap. What a file does not say of angle and place along the segment
/// is found from the seams: their edges lie beside each other as close as possible, with a gap
/// that is doubled, at most five times, while the panels that they join intersect.
///
/// @param meshes of all panels of the pattern, by triangulate()
/// @throws std::invalid_argument naming a carrier whose segment the body does not have, and as
///   placeBySeams()
Preposition preposition(const Pattern& pattern, const Body& body, std::vector<PanelMesh>& meshes);

}  // namespace haptex::garment
