// Heights of a surface over a rectangular grid in the fabric's rest coordinates.
#pragma once

#include <vector>

namespace haptex::tactile {

struct HeightField {
  int columns = 0;              ///< samples along weft
  int rows = 0;                 ///< samples along warp
  double weft_spacing = 0.0;    ///< m, between neighbouring columns
  double warp_spacing = 0.0;    ///< m, between neighbouring rows
  std::vector<double> heights;  ///< m, row by row: index columns row + column

  double at(int column, int row) const { return heights[columns * row + column]; }
};

/// @throws std::invalid_argument naming field, value and what is allowed: 2 to kMaxSamples columns
///   and rows, as many heights as that, finite, and spacings > 0
void requireSound(const HeightField& field);
constexpr int kMaxSamples = 4096;

/// Takes off the least-squares plane.
/// @param field sound, see above
void removePlane(HeightField& field);

}  // namespace haptex::tactile
