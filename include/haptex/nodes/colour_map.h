// Colours for strains.
#pragma once

#include <Eigen/Core>

namespace haptex::nodes {

/// Red, green and blue from 0 to 1 of the perceptually ordered colour map viridis (Smith and van
/// der Walt 2015): dark violet over blue and green to yellow, brighter all the way.
/// @param fraction along the map; below 0 and NaN give its begin, above 1 its end
Eigen::Vector3f viridis(double fraction);

/// Where on the colour map a strain lies: sqrt(strain / full_scale). The square root leaves a
/// visible difference to strains of a few percent of the full scale, as of a sample that hangs
/// under its own weight on a scale made for one that is stretched.
double strainFraction(double strain, double full_scale);

/// The largest principal value of the Green-Lagrange strain (weft, warp, shear U.V).
double largestPrincipalStrain(const Eigen::Vector3d& strain);

}  // namespace haptex::nodes
