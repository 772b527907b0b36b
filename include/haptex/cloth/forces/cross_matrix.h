// The cross product as a matrix.
#pragma once

#include <Eigen/Core>

namespace haptex::cloth {

/// Of a x b as a function of b, of which it is the derivative.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return matrix;
}

}  // namespace haptex::cloth
