// Surfaces whose spectrum is known without a transform, for tests and validations.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "haptex/material/surface.h"
#include "haptex/tactile/height_field.h"

namespace haptex::oracles {

inline tactile::HeightField flatField(int columns, int rows, double weft_spacing = 1e-4,
                                      double warp_spacing = 1e-4) {
  return {columns, rows, weft_spacing, warp_spacing,
          std::vector<double>(static_cast<std::size_t>(columns) * rows, 0.0)};
}

/// Adds a wave with `along_weft` and `along_warp` periods over the field.
/// @param amplitude m @param phase rad
inline void addGrating(tactile::HeightField& field, int along_weft, int along_warp,
                       double amplitude, double phase = 0.3) {
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const double turns = static_cast<double>(along_weft * column) / field.columns +
                           static_cast<double>(along_warp * row) / field.rows;
      field.heights[field.columns * row + column] +=
          amplitude * std::cos(2.0 * M_PI * turns + phase);
    }
  }
}

/// Independent heights of mean 20 um and standard deviation 5 um, the same at every call.
inline tactile::HeightField whiteNoise(int columns, int rows) {
  tactile::HeightField field = flatField(columns, rows, 1e-4, 1.3e-4);
  std::mt19937 generator(1);
  std::normal_distribution<double> height(2e-5, 5e-6);
  for (double& value : field.heights) value = height(generator);
  return field;
}

/// A weave whose yarns are alike in both directions.
inline material::Weave evenWeave(material::WeaveKind kind, double irregularity) {
  return {kind, {0.5e-3, 5e-5}, {0.5e-3, 5e-5}, irregularity};
}

/// m^2, about the mean.
inline double variance(const tactile::HeightField& field) {
  const double count = static_cast<double>(field.heights.size());
  double mean = 0.0, sum = 0.0;
  for (const double height : field.heights) mean += height / count;
  for (const double height : field.heights) sum += (height - mean) * (height - mean);
  return sum / count;
}

/// Unit vector at an angle to the weft.
inline Eigen::Vector2d direction(double degrees) {
  return {std::cos(degrees * M_PI / 180.0), std::sin(degrees * M_PI / 180.0)};
}

}  // namespace haptex::oracles
