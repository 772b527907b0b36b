// Where the edges of panels are divided, so that the particles of both sides of a seam meet.
#pragma once

#include <vector>

#include "haptex/garment/pattern/pattern.h"
#include "haptex/garment/triangulation/panel_mesh.h"

namespace haptex::garment {

/// Places that meet along a seam, ascending from its start: shares of the length of each side, from
/// 0 to 1.
struct SeamPlaces {
  std::vector<double> first, second;

  /// The share of the first side that meets one of the second. Between places linear.
  double onFirst(double second_share) const;
  double onSecond(double first_share) const;
};

struct SeamDivisions {
  std::vector<EdgeDivisions> panels;  ///< empty for edges that are in no seam
  std::vector<SeamPlaces> seams;
};

/// @param pattern sound @param edge_length, tolerance m, > 0, as of triangulate()
SeamDivisions divideSeams(const Pattern& pattern, double edge_length, double tolerance);

/// Divides a side in one more place, unless it is divided there.
/// @param share of its length, in the order of the seam
/// @param divisions of its panel; those of the side are not empty
/// @return whether it was not
bool divideAt(const Pattern& pattern, const SeamSide& side, double share, EdgeDivisions& divisions);

/// Lengths along the edges of a side: of its edges in the order of the seam the length (m) up to
/// each of them, and of all at the end.
std::vector<double> passedLengths(const Pattern& pattern, const SeamSide& side);
/// Its edges in the order of the seam.
std::vector<int> sewnEdges(const Pattern& pattern, const SeamSide& side);

}  // namespace haptex::garment
