// Cylinders and cones on which panels are laid without stretching them.
#pragma once

#include <Eigen/Core>

namespace haptex::garment {

/// A cylinder or a circular cone around an axis. Lengths in metres, world frame.
struct CarrierSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the axis, where the height is 0
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();     ///< along the axis, of length 1
  Eigen::Vector3d front =
      Eigen::Vector3d::UnitX();  ///< across it, of length 1: where the angle is 0
  double radius = 0.0;           ///< at height 0
  double slope = 0.0;            ///< by how much the radius shrinks per height; 0: a cylinder

  double radiusAt(double height) const { return radius - slope * height; }
};

/// Where a panel's middle lies: on the generator at that angle (rad, counter-clockwise seen from
/// above, where `up` points) at a height (m, along the axis).
struct PlaceOnSurface {
  double angle = 0.0;
  double height = 0.0;
};

/// A point of a panel that is rolled on the surface with its right side outwards. The map is an
/// isometry: a cone is unrolled into the sector of a plane around its apex, in which the panel lies
/// as it is cut, its y axis along the generator through its middle.
///
/// With sigma = sin of the cone's half angle, r the radius in the middle and a = r - sigma y the
/// point is at the radius R = |(a, sigma x)|, turned from the middle by atan2(sigma x, a) / sigma,
/// and (2 r y - sigma (x^2 + y^2)) / (r + R) farther up the generator; for a cylinder these are r,
/// x / r and y.
///
/// @param offset m, from the panel's middle: x to the right as seen from outside, y up
/// @param place  where the radius is > 0
Eigen::Vector3d lay(const CarrierSurface& surface, const PlaceOnSurface& place,
                    const Eigen::Vector2d& offset);

/// m, of the shortest way on the unrolled surface between two points of it that are less than half
/// a turn apart; from the points alone.
double lengthOnSurface(const CarrierSurface& surface, const Eigen::Vector3d& a,
                       const Eigen::Vector3d& b);

}  // namespace haptex::garment
