// Light that goes from yarn to yarn.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/appearance/reflectance.h"
#include "haptex/appearance/relief_surface.h"

namespace haptex::appearance {

/// Light on a relief between its texels. From every texel rays go out, once, in directions that are
/// distributed by the cosine to its normal; each meets a texel or leaves towards the sky. With them
/// are solved, for every light, B = R (E + F B): B is the radiosity, E the light that arrives
/// directly, F the mean over the texels that the rays meet, R the albedo. F and the share of rays
/// that leave add up to 1 for every texel: however few the rays are, a white relief under an even
/// sky is as bright as the sky.
///
/// On its first and its last reflection the whole reflectance acts on the light, so that its way
/// can be turned round; on those between it is reflected diffusely, with the same albedo.
class Interreflection {
 public:
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// For lights with an irradiance of 1 perpendicular to each, row per texel.
  struct Light {
    std::vector<Eigen::Vector3d> directions;  ///< towards the lights, unit, z > 0
    Matrix arriving;                          ///< irradiance without reflection; column per light
    Matrix radiosity;                         ///< B; column 3 light + channel
  };

  Interreflection(const ReliefSurface& surface, const material::Look& look);

  const ReliefSurface& surface() const { return surface_; }
  const Reflectance& reflectance() const { return reflectance_; }

  /// From each texel: 100 while gloss is at most half of the width of the highlight, up to 400
  /// where it is as much or more.
  int rays() const { return static_cast<int>(rays_.size()); }

  /// Share of the rays of a texel that leave the relief.
  double openShare(int texel) const;

  /// @param directions towards the lights, unit, z > 0
  Light solve(const std::vector<Eigen::Vector3d>& directions) const;

  /// 1/sr: radiance that a texel sends by light from other texels.
  /// @param views unit
  /// @returns row per view, column 3 light + channel
  Matrix send(int texel, const Light& light, const std::vector<Eigen::Vector3d>& views) const;

 private:
  Eigen::Vector3d rayOf(int texel, int ray) const;
  Matrix arriving(const std::vector<Eigen::Vector3d>& directions) const;
  Matrix radianceMet(const Light& light, const std::vector<int>& met,
                     const std::vector<Eigen::Vector3d>& rays) const;

  ReliefSurface surface_;
  Reflectance reflectance_;
  std::vector<ReliefSurface::Point> centres_;
  std::vector<Eigen::Vector3d> rays_;  // around z
  std::vector<int> met_;               // of texel and ray; -1: leaves
};

}  // namespace haptex::appearance
