// How a yarn's surface reflects light.
#pragma once

#include <Eigen/Core>
#include <array>

#include "haptex/material/surface.h"

namespace haptex::appearance {

/// A bidirectional reflectance of two parts: Lambert's in the colour of the yarn, with the share
/// 1 - gloss of the light, and a highlight with the share gloss, in the colour of the light. Both
/// are reciprocal, and neither loses light: a white yarn reflects all of it, from every direction.
///
/// The highlight is that of facets with Trowbridge and Reitz's distribution (GGX, Walter et al.
/// 2007), its roughness alpha the `width` of the look, at least 0.05, with Smith's
/// height-correlated masking and shadowing. What it loses between facets is added as Kulla and
/// Conty do (2017).
class Reflectance {
 public:
  /// @throws std::invalid_argument naming gloss outside of 0 to 1, width of above 0 to 1, or a
  ///   colour outside of 0 to 1
  explicit Reflectance(const material::Look& look);

  const material::Look& look() const { return look_; }

  /// 1/sr, of the highlight alone for gloss 1.
  /// @param normal, light, view unit @returns 0 unless light and view are above the surface
  double highlight(const Eigen::Vector3d& normal, const Eigen::Vector3d& light,
                   const Eigen::Vector3d& view) const;

  /// 1/sr, red, green and blue. Directions as above.
  Eigen::Vector3d of(bool warp, const Eigen::Vector3d& normal, const Eigen::Vector3d& light,
                     const Eigen::Vector3d& view) const;

  /// Share of the light that comes back, in all directions together.
  Eigen::Vector3d albedo(bool warp) const;

 private:
  static constexpr int kCosines = 65;

  double returned(double cosine) const;
  double single(double light_cosine, double view_cosine, double half_cosine) const;

  material::Look look_;
  double alpha_squared_;
  // Share of the light that facets reflect at once, by the cosine of its direction: 0 to 1 evenly.
  std::array<double, kCosines> returned_;
  double lost_;  // share of diffuse light that they do not
};

}  // namespace haptex::appearance
