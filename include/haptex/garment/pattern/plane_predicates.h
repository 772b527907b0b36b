// Exact decisions about points of a plane.
#pragma once

#include <Eigen/Core>

namespace haptex::garment {

/// 1 if a, b and c turn counter-clockwise, -1 if clockwise, 0 if they lie on a line; exactly.
/// @param a, b, c m, coordinates of 0 or between 1e-60 and 1e60
int turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// 1 if d lies inside of the circle through a, b and c, which turn counter-clockwise, -1 if
/// outside, 0 if on it; exactly. Shewchuk, Adaptive precision floating-point arithmetic and fast
/// robust geometric predicates, Discrete & Computational Geometry 18 (1997): in doubles where the
/// bound of their error allows.
int inCircle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
             const Eigen::Vector2d& d);

/// Whether two line segments have a point in common, exactly.
bool touch(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d);

}  // namespace haptex::garment
