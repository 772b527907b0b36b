// A triangle of the membrane, and how its tangent and tractions are shared out to its three
// particles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// A triangle at rest. U = sum_i weft_weights[i] P_i is the deformed image of the unit vector
/// along weft, V likewise along warp (no unit); the weights (1/m) sum to zero.
struct MembraneElement {
  std::array<int, 3> particles;        ///< ascending
  std::array<int, 3> slots;            ///< of the matrix blocks (1,0), (2,0), (2,1)
  std::array<double, 3> weft_weights;  ///< ru of the design, 1/m
  std::array<double, 3> warp_weights;  ///< rv, 1/m
  double area;                         ///< at rest, m^2
};

/// U and V of an element (MembraneElement), or their rates if the points are velocities.
struct ElementFrame {
  Eigen::Vector3d weft;
  Eigen::Vector3d warp;
};

inline ElementFrame elementFrame(const MembraneElement& element,
                                 const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d& origin = points[element.particles[0]];
  const Eigen::Vector3d edge_1 = points[element.particles[1]] - origin;
  const Eigen::Vector3d edge_2 = points[element.particles[2]] - origin;
  return {element.weft_weights[1] * edge_1 + element.weft_weights[2] * edge_2,
          element.warp_weights[1] * edge_1 + element.warp_weights[2] * edge_2};
}

/// Adds the blocks of one element to the matrix.
/// @param block of (i, j), from which those with particle 0 follow, because the weights sum to zero
template <typename Block>
void addElementBlocks(const MembraneElement& element, Block&& block,
                      linear::SymmetricBlockMatrix& matrix) {
  const Eigen::Matrix3d b11 = block(1, 1);
  const Eigen::Matrix3d b21 = block(2, 1);
  const Eigen::Matrix3d b22 = block(2, 2);
  const Eigen::Matrix3d b10 = -b11 - b21.transpose();
  const Eigen::Matrix3d b20 = -b21 - b22;
  matrix.diagonal(element.particles[0]) -= b10 + b20;
  matrix.diagonal(element.particles[1]) += b11;
  matrix.diagonal(element.particles[2]) += b22;
  matrix.lower(element.slots[0]) += b10;
  matrix.lower(element.slots[1]) += b20;
  matrix.lower(element.slots[2]) += b21;
}

/// Distributes the tractions conjugate to U and V (times the rest area) to the particles.
/// @param target of a particle, what its share is added to
template <typename Target>
void addScattered(const MembraneElement& element, const Eigen::Vector3d& weft_traction,
                  const Eigen::Vector3d& warp_traction, Target&& target) {
  const Eigen::Vector3d at_1 =
      element.weft_weights[1] * weft_traction + element.warp_weights[1] * warp_traction;
  const Eigen::Vector3d at_2 =
      element.weft_weights[2] * weft_traction + element.warp_weights[2] * warp_traction;
  target(element.particles[0]) -= at_1 + at_2;
  target(element.particles[1]) += at_1;
  target(element.particles[2]) += at_2;
}

}  // namespace haptex::cloth
