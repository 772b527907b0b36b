// Colours for strains.
#pragma once

#include <Eigen/Core>

namespace haptex::nodes {

/// Red, green and blue from 0 to 1 of the perceptually ordered colour map viridis (Smith and van
/// der Walt 2015): dark violet over blue and green to yellow, brighter all the way.
/// @param fraction along the map; below 0 and NaN give its begin, above 1 its end
Eigen::Vector3f viridis(double fraction);

/// Decades that the colour map spans.
constexpr int kStrainDecades = 4;

/// Where on the colour map a strain lies: logarithmic over kStrainDecades decades up to the full
/// scale, so that one scale shows a stiff fabric hanging (some 1e-5) and stretched (some 1e-2).
double strainFraction(double strain, double full_scale);

/// The largest principal value of the Green-Lagrange strain (weft, warp, shear U.V).
double largestPrincipalStrain(const Eigen::Vector3d& strain);

}  // namespace haptex::nodes
