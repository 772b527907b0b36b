// The virtual surface tester of the Kawabata Evaluation System: SMD and MMD of a relief.
#pragma once

#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// What the tester finds, the mean of strokes along weft and along warp.
struct KesSurface {
  double roughness;        ///< m, SMD: mean absolute deviation of the height
  double slope_deviation;  ///< mean absolute deviation of the slope along the stroke, no unit
};

/// Strokes a field that continues at its opposite edge, along every row and every column. As in the
/// tester, a high-pass of second order takes out what is longer than about 1 mm: natural frequency
/// 1 Hz at 1 mm/s, damping ratio 0.6 (Kawabata 1980, The Standardization and Analysis of Hand
/// Evaluation, 2nd edition, Textile Machinery Society of Japan).
/// @throws what requireSound() throws
KesSurface testSurface(const HeightField& periodic);

}  // namespace haptex::tactile
