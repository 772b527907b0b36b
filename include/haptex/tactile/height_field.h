// Heights of a surface over a rectangular grid in the fabric's rest coordinates.
#pragma once

#include <cstddef>
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

// Of reliefs that are computed, and of pieces of measured ones.
constexpr double kReliefSpacing = 1e-4;  ///< m, between samples, aimed at
constexpr int kReliefSamples = 128;      ///< along a side, at most

/// @param weft_spacing, warp_spacing m
/// @param height_at m, of a column and a row
template <typename HeightAt>
HeightField makeField(int columns, int rows, double weft_spacing, double warp_spacing,
                      const HeightAt& height_at) {
  HeightField field{columns, rows, weft_spacing, warp_spacing, {}};
  field.heights.reserve(static_cast<std::size_t>(columns) * rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      field.heights.push_back(height_at(column, row));
    }
  }
  return field;
}

/// @throws std::invalid_argument naming field, value and what is allowed: 2 to kMaxSamples columns
///   and rows, as many heights as that, finite, and spacings > 0
void requireSound(const HeightField& field);
constexpr int kMaxSamples = 4096;

/// Takes off the least-squares plane.
/// @param field sound, see above
void removePlane(HeightField& field);

}  // namespace haptex::tactile
