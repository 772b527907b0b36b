// The small-scale description of a surface: its 2D spatial spectrum.
#pragma once

#include <vector>

#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// The waves that a surface is the sum of, each wave vector and its opposite together. The mean is
/// left out: nobody feels it.
struct KSpace {
  std::vector<double> weft;   ///< rad/m, component of the wave vector
  std::vector<double> warp;   ///< rad/m
  std::vector<double> power;  ///< m^2, mean square height of the wave: a^2/2 for amplitude a

  std::size_t size() const { return power.size(); }
  /// m^2: the variance of the surface (Parseval).
  double totalPower() const;
};

/// The discrete Fourier transform of a field that continues at its opposite edge:
///   H(m, n) = 1/(M N) sum_(c, r) h(c, r) exp(-2 pi i (m c/M + n r/N)),
///   k = 2 pi (m/(M weft_spacing), n/(N warp_spacing)), power 2 |H|^2 for k and -k together.
/// At half of an even M or N samples do not tell a wave from its mirror image: each gets half.
/// Waves without power are left out.
/// @throws what requireSound() throws
KSpace kSpaceOfPeriodic(const HeightField& field);

/// The same of a piece of a larger surface: the mean plane is taken off, the edges are faded out by
/// a Hann window, and the power is scaled to the variance about that plane.
/// @throws what requireSound() throws
KSpace kSpaceOfPiece(const HeightField& field);

}  // namespace haptex::tactile
