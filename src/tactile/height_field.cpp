#include "haptex/tactile/height_field.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {
namespace {

void requireCount(const char* name, int count) {
  if (count >= 2 && count <= kMaxSamples) return;
  std::ostringstream message;
  message << "the height field has " << count << ' ' << name << ": allowed are 2 to "
          << kMaxSamples;
  throw std::invalid_argument(message.str());
}

void requireSpacing(const char* name, double spacing) {
  if (std::isfinite(spacing) && spacing > 0.0) return;
  std::ostringstream message;
  message << "the " << name << " of the height field is " << spacing
          << " m: it must be finite and > 0";
  throw std::invalid_argument(message.str());
}

}  // namespace

void requireSound(const HeightField& field) {
  requireCount("columns", field.columns);
  requireCount("rows", field.rows);
  requireSpacing("weft_spacing", field.weft_spacing);
  requireSpacing("warp_spacing", field.warp_spacing);
  const std::size_t samples = static_cast<std::size_t>(field.columns) * field.rows;
  if (field.heights.size() != samples) {
    std::ostringstream message;
    message << "the height field has " << field.heights.size() << " heights: " << field.columns
            << " columns and " << field.rows << " rows need " << samples;
    throw std::invalid_argument(message.str());
  }
  for (std::size_t i = 0; i < samples; ++i) {
    if (std::isfinite(field.heights[i])) continue;
    std::ostringstream message;
    message << "heights[" << i << "] of the height field is " << field.heights[i]
            << ": it must be finite";
    throw std::invalid_argument(message.str());
  }
}

void removePlane(HeightField& field) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto basis = [&](int column, int row) {
    return Eigen::Vector3d(1.0, 2.0 * column / (field.columns - 1) - 1.0,
                           2.0 * row / (field.rows - 1) - 1.0);
  };
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const Eigen::Vector3d place = basis(column, row);
      normal += place * place.transpose();
      right += field.at(column, row) * place;
    }
  }
  const Eigen::Vector3d plane = normal.ldlt().solve(right);
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      field.heights[static_cast<std::size_t>(field.columns) * row + column] -=
          plane.dot(basis(column, row));
    }
  }
}

}  // namespace haptex::tactile
