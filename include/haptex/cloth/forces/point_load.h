// Forces on points of a cloth that depend linearly on where the point is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/membrane.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// A force on a point of a triangle that depends on where the point is:
///   force(x) = force - stiffness (x - position),  x = sum_i weights[i] x_i over the corners.
/// World frame.
struct PointLoad {
  int triangle;               ///< of the mesh
  Eigen::Vector3d weights;    ///< barycentric, sum 1
  Eigen::Vector3d position;   ///< m
  Eigen::Vector3d force;      ///< N
  Eigen::Matrix3d stiffness;  ///< N/m, symmetric, positive semidefinite
};

using Triangles = std::vector<std::array<int, 3>>;  ///< of a mesh, particle indices

/// The load with the part of its stiffness that is exactly symmetric and positive semidefinite,
/// which the tolerances of Cloth::setPointLoads() leave a little beside it.
/// @param index for the message
/// @throws std::invalid_argument as Cloth::setPointLoads()
PointLoad checkedLoad(const PointLoad& load, std::size_t index, std::size_t triangle_count);

/// Adds the forces (N) of all loads on the particles.
void addPointForces(const std::vector<PointLoad>& loads, const Triangles& triangles,
                    const Positions& positions, std::vector<Eigen::Vector3d>& forces);

/// Sum of -force . d + d . stiffness d / 2 with d = x - position (J).
double pointLoadEnergy(const std::vector<PointLoad>& loads, const Triangles& triangles,
                       const Positions& positions);

/// Adds what the loads contribute to a linearised stage (Stage), for all corners i and j of their
/// triangles:
///   matrix_ij += a^2 weights_i weights_j stiffness
///   rhs_i     += a weights_i (force - stiffness (x + ahead v - position)).
/// @param elements of the membrane on the same triangles, with slots of the matrix
void addPointLoadStep(const std::vector<PointLoad>& loads, const Triangles& triangles,
                      const std::vector<MembraneElement>& elements, const Positions& positions,
                      const Velocities& velocities, const StageTimes& times,
                      linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs);

}  // namespace haptex::cloth
