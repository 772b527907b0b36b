// On which side a point lies, without rounding.
#pragma once

#include <Eigen/Core>

namespace haptex::proximity {

/// The sign of (b - a) . ((c - a) x (d - a)), exactly: 1 if a, b and c turn counter-clockwise seen
/// from where d is not, 0 if the four lie in a plane. Computed in double precision where the bound
/// of its error allows (Shewchuk 1997), else with ExactNumber.
/// @param a, b, c, d m, coordinates of 0 or between 1e-60 and 1e60
int orientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Eigen::Vector3d& d);

/// The sign of the area of a triangle that is projected along a coordinate axis, exactly: 1 if a, b
/// and c turn counter-clockwise seen from the axis' tip.
/// @param axis 0, 1 or 2
int projectedOrientation(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c, int axis);

}  // namespace haptex::proximity
