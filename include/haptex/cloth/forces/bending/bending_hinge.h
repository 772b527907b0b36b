// A group of neighbouring particles that resists bending.
#pragma once

#include <Eigen/Core>

namespace haptex::cloth {

/// Neighbouring particles whose bending vector sum_i weight_i P_i is zero in every affine image of
/// the rest shape, so in every flat state. Its energy is stiffness / 2 times its square.
struct Hinge {
  int begin;  ///< of its corners in Bending::corners()
  int end;
  double stiffness;         ///< N/m, > 0
  Eigen::Vector3d resists;  ///< m^2: with the second derivatives k = (wuu, wvv, wuv) its bending
                            ///< vector has the length |resists . k|
};

struct HingeCorner {
  int particle;
  double weight;  ///< no unit; those of a hinge have the sum 0
};

}  // namespace haptex::cloth
