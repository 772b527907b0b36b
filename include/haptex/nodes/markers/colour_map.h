// Colours for strains and for things to be told apart.
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

/// Red, green and blue from 0 to 1 of things to be told apart: full colours whose hues are a golden
/// section of the circle apart, so that however many there are, neighbours differ.
/// @param index >= 0
Eigen::Vector3f distinctColour(int index);

}  // namespace haptex::nodes
