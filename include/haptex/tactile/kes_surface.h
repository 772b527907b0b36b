// The virtual surface tester of the Kawabata Evaluation System: SMD and MMD of a relief.
#pragma once

#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// What the tester finds: the mean of strokes along weft and along warp, there and back.
struct KesSurface {
  double roughness;  ///< m, SMD: mean absolute deviation of the height
  /// Mean absolute deviation of the derivative of the same profile along the stroke, no unit. MMD
  /// over this is the deviation of friction per slope.
  double slope_deviation;
};

/// Strokes a field that continues at its opposite edge, along every row and every column, and
/// compares each profile with its own mean. As in the tester, a high-pass of second order,
///   s^2/(s^2 + 2 zeta w0 s + w0^2),
/// takes out what is longer than about 1 mm: natural frequency w0/(2 pi) 1 Hz at a speed of 1 mm/s,
/// damping ratio zeta 0.6 (Kawabata 1980, The Standardization and Analysis of Hand Evaluation, 2nd
/// edition, Textile Machinery Society of Japan). Filter and derivative are exact for the waves of
/// the profile; the mean is that of its samples.
/// @throws what requireSound() throws
KesSurface testSurface(const HeightField& periodic);

}  // namespace haptex::tactile
