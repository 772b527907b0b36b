// The large-scale description of a surface: how its amplitudes vary from place to place.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/tactile/channels.h"

namespace haptex::tactile {

/// Per channel the amplitude of a place over that of the whole surface, on a grid of 1 mm that
/// continues at its opposite edge.
class AmplitudeMap {
 public:
  static constexpr double kSpacing = 1e-3;  ///< m

  /// A uniform surface: 1 everywhere.
  AmplitudeMap() : AmplitudeMap(1, 1, {{1.0, 1.0}}) {}
  /// @param values row by row, one pair per cell; >= 0
  /// @throws std::invalid_argument naming the size or the value
  AmplitudeMap(int columns, int rows, std::vector<PerChannel<double>> values);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Between the cells' centres, which lie at whole multiples of kSpacing, by bilinear weights.
  /// @param place m, along weft and warp; finite @returns 1 where it is not
  PerChannel<double> at(const Eigen::Vector2d& place) const;

 private:
  int columns_;
  int rows_;
  std::vector<PerChannel<double>> values_;
};

}  // namespace haptex::tactile
