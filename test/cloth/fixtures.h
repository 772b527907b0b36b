// Fabrics, systems and states that several tests of the cloth room use.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/material/linear_fabric.h"

namespace haptex::cloth {

/// 100 N/m along the threads, 50 N/m in shear, 0.1 kg/m2.
inline material::Fabric linearFabric(double viscosity = 0.0) {
  return material::linearFabric(100.0, viscosity);
}

/// Anisotropic and stiffening, with viscosity.
inline material::Fabric stiffeningFabric() {
  using material::NegativeBranch;
  using material::StrainStressCurve;
  material::Fabric fabric = linearFabric(0.5);
  fabric.weft.elastic =
      StrainStressCurve::fit({{0.05, 10.0}, {0.1, 40.0}, {0.2, 200.0}}, NegativeBranch::kLinear);
  fabric.warp.elastic =
      StrainStressCurve::fit({{0.02, 40.0}, {0.05, 200.0}, {0.1, 900.0}}, NegativeBranch::kLinear);
  fabric.shear.elastic =
      StrainStressCurve::fit({{0.1, 3.0}, {0.3, 20.0}, {0.6, 90.0}}, NegativeBranch::kOdd);
  return fabric;
}

/// A pose that is not turned.
inline Eigen::Isometry3d placedAt(const Eigen::Vector3d& place) {
  return Eigen::Isometry3d(Eigen::Translation3d(place));
}

inline mesh::ClothMesh square(int cells, double size = 0.1) {
  return mesh::makeRectangle(size, size, cells, cells, mesh::Triangulation::kAlternating);
}

/// The initial state with every coordinate and velocity moved at random.
inline ClothState randomState(const Cloth& cloth, double displacement, double speed,
                              unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  ClothState state = cloth.initialState();
  for (auto& position : state.positions) {
    for (int axis = 0; axis < 3; ++axis) position[axis] += displacement * normal(random);
  }
  for (auto& velocity : state.velocities) {
    for (int axis = 0; axis < 3; ++axis) velocity[axis] = speed * normal(random);
  }
  return state;
}

/// A random symmetric positive definite matrix on the pattern of a mesh.
inline linear::SymmetricBlockMatrix randomDefinite(const mesh::ClothMesh& mesh, double stiffness,
                                                   unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const int size = static_cast<int>(mesh.rest_coordinates.size());
  linear::SymmetricBlockMatrix matrix(size, mesh.triangles);
  for (int i = 0; i < size; ++i) {
    matrix.diagonal(i) += Eigen::Matrix3d::Identity();
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
      const Eigen::Vector3d other(normal(random), normal(random), normal(random));
      // [d; e][d; e]^T on the two particles keeps the sum definite and the blocks not symmetric.
      matrix.diagonal(i) += stiffness * direction * direction.transpose();
      matrix.diagonal(matrix.column(s)) += stiffness * other * other.transpose();
      matrix.lower(s) += stiffness * direction * other.transpose();
    }
  }
  return matrix;
}

inline Eigen::MatrixXd dense(const linear::SymmetricBlockMatrix& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * matrix.size(), 3 * matrix.size());
  for (int i = 0; i < matrix.size(); ++i) {
    result.block<3, 3>(3 * i, 3 * i) = matrix.diagonal(i);
    for (int s = matrix.rowBegin(i); s < matrix.rowBegin(i + 1); ++s) {
      const int j = matrix.column(s);
      result.block<3, 3>(3 * i, 3 * j) = matrix.lower(s);
      result.block<3, 3>(3 * j, 3 * i) = matrix.lower(s).transpose();
    }
  }
  return result;
}

inline Eigen::VectorXd stacked(const linear::BlockVector& vector) {
  return Eigen::Map<const Eigen::VectorXd>(vector.data(), vector.size());
}

}  // namespace haptex::cloth
