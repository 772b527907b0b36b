// Light on a fabric's relief by following it, reflection by reflection.
#pragma once

#include <Eigen/Core>

#include "haptex/appearance/reflectance.h"
#include "haptex/appearance/relief_surface.h"
#include "haptex/base/repeatable_random.h"

namespace haptex::oracles {

/// Radiance in red, green and blue, 1/sr, mean over the repeat, for an irradiance of 1
/// perpendicular to the light: by paths at random from the eye, which end where they leave the
/// relief. Every reflection is by the whole reflectance, at the place that is met; there are no
/// texels to gather by, no directions to interpolate between and nothing is compressed.
/// @param view, light unit, z >= appearance::kFlattest
/// @param paths along a side of the repeat, one in each square of as many squared
Eigen::Vector3d radianceByPaths(const appearance::ReliefSurface& surface,
                                const appearance::Reflectance& reflectance,
                                const Eigen::Vector3d& view, const Eigen::Vector3d& light,
                                int paths, base::RepeatableRandom& random);

}  // namespace haptex::oracles
