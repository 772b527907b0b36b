// A triangle of the membrane, and how its tangent and tractions are shared out to its three
// particles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/jacobian_rows.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A triangle at rest. U = sum_i weft_weights[i] P_i is the deformed image of the unit vector
/// along weft, V likewise along warp (no unit); the weights (1/m) sum to zero.
struct MembraneElement {
  std::array<int, 3> particles;        ///< ascending
  std::array<int, 3> slots;            ///< of the matrix blocks (1,0), (2,0), (2,1); -1 before
                                       ///< bindElements()
  std::array<double, 3> weft_weights;  ///< ru of the design, 1/m
  std::array<double, 3> warp_weights;  ///< rv, 1/m
  double area;                         ///< at rest, m^2
};

/// A triangle at rest: the derivatives of what is linear in it, along weft and warp, as weights of
/// its values in the corners.
struct RestTriangle {
  std::array<double, 3> weft_weights, warp_weights;  ///< 1/m
  double area;                                       ///< m^2
};
/// @param corners (u along weft, v along warp), m
RestTriangle restTriangle(const std::array<Eigen::Vector2d, 3>& corners);

/// The elements of all triangles of a mesh without defects, or of those of one fabric.
std::vector<MembraneElement> restElements(const mesh::ClothMesh& mesh,
                                          std::optional<int> fabric = std::nullopt);
/// Those of some triangles.
std::vector<MembraneElement> restElements(const mesh::ClothMesh& mesh,
                                          const std::vector<int>& triangles);

/// Looks up the slots of elements in a matrix.
/// @throws std::out_of_range if the pattern lacks one of them
void bindElements(const linear::SymmetricBlockMatrix& matrix,
                  std::vector<MembraneElement>& elements);

/// A third of each adjacent triangle, per particle: of its area (m^2) times `density`.
/// @param density of an element, by its place: of the area what is to be shared out
template <typename Density>
std::vector<double> shareOut(const std::vector<MembraneElement>& elements,
                             std::size_t particle_count, const Density& density) {
  std::vector<double> shares(particle_count, 0.0);
  for (std::size_t t = 0; t < elements.size(); ++t) {
    for (int particle : elements[t].particles) {
      shares[particle] += density(t) * elements[t].area / 3.0;
    }
  }
  return shares;
}

/// Blocks [i][j] of the particles of an element, in its order.
struct ElementJacobian {
  std::array<std::array<Eigen::Matrix3d, 3>, 3> by_position;  ///< N/m
  std::array<std::array<Eigen::Matrix3d, 3>, 3> by_velocity;  ///< N.s/m
};

/// Adds the rows that are asked for. @param jacobian of an element
template <typename Jacobian>
void addElementJacobians(const std::vector<MembraneElement>& elements, const Jacobian& jacobian,
                         JacobianRows& rows) {
  for (const MembraneElement& element : elements) {
    const auto& [a, b, c] = element.particles;
    if (!rows.asksFor(a) && !rows.asksFor(b) && !rows.asksFor(c)) continue;
    const ElementJacobian blocks = jacobian(element);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        rows.add(element.particles[i], element.particles[j], blocks.by_position[i][j],
                 blocks.by_velocity[i][j]);
      }
    }
  }
}

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

/// Green-Lagrange strains or their rates (1/s) in the order weft (U.U-1)/2, warp (V.V-1)/2,
/// shear U.V.
using MembraneStrain = Eigen::Vector3d;

/// Green-Lagrange strain of an element. @param frame of elementFrame() of the positions
inline MembraneStrain greenStrain(const ElementFrame& frame) {
  return {0.5 * (frame.weft.squaredNorm() - 1.0), 0.5 * (frame.warp.squaredNorm() - 1.0),
          frame.weft.dot(frame.warp)};
}
inline MembraneStrain greenStrain(const MembraneElement& element,
                                  const std::vector<Eigen::Vector3d>& positions) {
  return greenStrain(elementFrame(element, positions));
}

/// The rates (1/s) of the strains at velocities. @param frame of the positions @param rate of the
/// velocities
inline MembraneStrain greenStrainRate(const ElementFrame& frame, const ElementFrame& rate) {
  return {frame.weft.dot(rate.weft), frame.warp.dot(rate.warp),
          rate.weft.dot(frame.warp) + frame.weft.dot(rate.warp)};
}

/// Column m is the derivative (1/m) of strain m by the position of corner i. With the frame of the
/// velocities it is that of the strain's rate.
inline Eigen::Matrix3d strainGradients(const MembraneElement& element, const ElementFrame& frame,
                                       int i) {
  const double ru = element.weft_weights[i], rv = element.warp_weights[i];
  Eigen::Matrix3d columns;
  columns << ru * frame.weft, rv * frame.warp, ru * frame.warp + rv * frame.weft;
  return columns;
}

/// The derivative (1/m^2) of the strains' gradient by the positions of corners i and j, times the
/// stress: that times the identity is what turning adds to a tangent.
inline double geometricStiffness(const MembraneElement& element, const Eigen::Vector3d& stress,
                                 int i, int j) {
  const double ru_i = element.weft_weights[i], ru_j = element.weft_weights[j];
  const double rv_i = element.warp_weights[i], rv_j = element.warp_weights[j];
  return stress[0] * ru_i * ru_j + stress[1] * rv_i * rv_j +
         stress[2] * (ru_i * rv_j + rv_i * ru_j);
}

/// Projects the symmetric tensor [[s0, s2], [s2, s1]] to its nearest positive semidefinite one
/// (Frobenius norm) by clamping its two eigenvalues in closed form.
Eigen::Vector3d projectStress(const Eigen::Vector3d& stress);

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

/// Adds factor * (tangent blocks of one element) to the matrix: the sum over the three strains of
/// slope g_i g_j^T (strainGradients()), plus that of weft and warp by their coupling, plus the
/// geometric part.
void addTangent(const MembraneElement& element, const ElementFrame& frame,
                const Eigen::Vector3d& slope, double coupling, const Eigen::Vector3d& stress,
                double factor, linear::SymmetricBlockMatrix& matrix);

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
