#include "haptex/tactile/height_field.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::tactile {
namespace {

void requireCount(const char* name, int count) {
  if (count >= 2 && count <= kMostSamples) return;
  std::ostringstream message;
  message << "the height field has " << count << ' ' << name << ": allowed are 2 to "
          << kMostSamples;
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

}  // namespace haptex::tactile
