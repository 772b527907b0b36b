// What the tests of the room have in common.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "haptex/appearance/btf.h"
#include "haptex/material/surface.h"
#include "haptex/tactile/height_field.h"
#include "haptex/tactile/relief_picture.h"

namespace haptex::appearance {

/// Heights of a function of the place, in a square of 16 x 16 samples of 0.1 mm, of warp alone.
template <typename HeightAt>
tactile::FaceRelief reliefOf(const HeightAt& height_at, int samples = 16) {
  tactile::FaceRelief relief;
  relief.heights = tactile::makeField(samples, samples, 1e-4, 1e-4, height_at);
  relief.warp_on_top.assign(relief.heights.heights.size(), true);
  return relief;
}

inline tactile::FaceRelief flatRelief() {
  return reliefOf([](int, int) { return 5e-5; });
}

/// Furrows along warp, as deep as half of the length of their wave, which is that of the repeat.
inline tactile::FaceRelief furrows(double depth = 8e-4) {
  return reliefOf([=](int column, int) { return 0.5 * depth * std::cos(M_PI * column / 8.0); });
}

/// A woven relief of yarns as high as wide.
inline tactile::FaceRelief twill() {
  return tactile::faceRelief(
      {4e-6, 0.01,
       material::Weave{material::WeaveKind::kTwill31, {4e-4, 1e-4}, {4e-4, 1e-4}, 0.1}});
}

inline material::Look lookOf(double warp, double weft, double gloss, double width) {
  return {{warp, warp, warp}, {weft, weft, weft}, gloss, width};
}

constexpr Compression kSmall{12, 1, 12};

inline Btf smallBtf(const tactile::FaceRelief& relief, const material::Look& look) {
  return makeBtf(relief, look, {32, 32, kSmall});
}

}  // namespace haptex::appearance
