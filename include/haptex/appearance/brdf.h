// How a fabric reflects light where its yarns are too small to be seen.
#pragma once

#include <Eigen/Core>

#include "haptex/appearance/btf.h"
#include "haptex/appearance/btf_measures.h"

namespace haptex::appearance {

/// The bidirectional reflectance distribution function (Nicodemus et al., Geometrical
/// considerations and nomenclature for reflectance, 1977): the mean over the repeat of a
/// bidirectional texture function (btf.h), which 79 kB hold. Directions are as there, linear
/// between the sampled ones, of any length.
class Brdf {
 public:
  /// Column of a view and a light: their places among the directions, kDirections view + light.
  using Table = Eigen::Matrix<float, 3, kDirections * kDirections>;

  /// @param reflectance 1/sr, red, green and blue, >= 0 and finite
  explicit Brdf(const Table& reflectance);

  /// Radiance in red, green and blue, 1/sr, for an irradiance of 1 perpendicular to the light; zero
  /// for light that does not come from above the fabric.
  /// @param view z > 0
  Eigen::Vector3f radiance(const Eigen::Vector3d& view, const Eigen::Vector3d& light) const;

  /// Under an even sky: radiance in parts of what a white matt surface shows.
  /// @param view z > 0
  Eigen::Vector3f underSky(const Eigen::Vector3d& view) const;

 private:
  Table reflectance_;
  Eigen::Matrix<float, 3, kDirections> under_sky_;  // by view
};

/// @returns means over 16 x 16 places, other ones for each pair of directions; two seconds of
///   computing with 256 x 256 texels (docs/appearance.md has how true it is)
Brdf meanOverRepeat(const Btf& btf);

/// Root mean square of the difference of a Brdf from the mean of its Btf over the pairs, in parts
/// of the root mean square of that mean. Directions are at random within 75 degrees from the
/// normal, the last sampled ones.
double meanError(const Btf& btf, const Brdf& brdf, const MeasureSize& size);

}  // namespace haptex::appearance
