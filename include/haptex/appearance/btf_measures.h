// How true a bidirectional texture function is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/appearance/btf.h"

namespace haptex::appearance {

/// What is measured with: places in a square grid over the repeat, moved by chance within their
/// part, and directions that are uniform over the hemisphere, so none is a sampled one.
struct MeasureSize {
  int places;         ///< along a side of the repeat, >= 1
  int pairs;          ///< of view and light, >= 1
  int lights;         ///< of the even sky, along each of two angles, >= 1
  int furnace_views;  ///< >= 1
  unsigned seed;
};

/// Places of a measurement, m.
std::vector<Eigen::Vector2d> placesOver(const Eigen::Vector2d& size, int along_a_side,
                                        unsigned seed);

/// Radiance, mean over the places, of the three channels.
Eigen::Vector3d meanRadiance(const Btf::Pair& pair, const std::vector<Eigen::Vector2d>& places);

/// Under an even sky of radiance 1, what is sent to views: the largest difference from 1 of the
/// mean over the repeat, of a Btf of white yarns.
double furnaceError(const Btf& white, const MeasureSize& size);

/// Root mean square of f(light, view) - f(view, light) over the pairs, f being the apparent
/// reflectance, mean over the repeat, relative to the root mean square of f.
double reciprocityError(const Btf& btf, const MeasureSize& size);

struct Difference {
  double of_mean;  ///< root mean square over places, pairs and channels, of the mean radiance
  double of_root_square;  ///< the same, of the root mean square of the radiance
};

/// Against direct ray casting: the same texels, with the light between them solved for each light
/// and reflected towards each view, neither interpolated nor compressed.
/// @param exact of the surface and look of the Btf
Difference unsampledError(const Btf& btf, const Interreflection& exact, const MeasureSize& size);

}  // namespace haptex::appearance
