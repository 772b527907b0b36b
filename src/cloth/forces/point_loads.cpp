#include "haptex/cloth/forces/point_loads.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "haptex/base/require.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triangles = std::vector<std::array<int, 3>>;

constexpr double kTolerance = 1e-6;  // of the weights' sum, and of the stiffness by its norm

/// The same point of all particles' vectors.
Vector3d interpolated(const PointLoad& load, const Triangles& triangles,
                      const std::vector<Vector3d>& vectors) {
  const std::array<int, 3>& corners = triangles[load.triangle];
  return load.weights[0] * vectors[corners[0]] + load.weights[1] * vectors[corners[1]] +
         load.weights[2] * vectors[corners[2]];
}

/// The force (N) on the point.
Vector3d pointForce(const PointLoad& load, const Triangles& triangles, const Positions& positions) {
  return load.force - load.stiffness * (interpolated(load, triangles, positions) - load.position);
}

/// The weights in the order of the element's particles, which is ascending.
Vector3d sortedWeights(const PointLoad& load, const std::array<int, 3>& corners,
                       const MembraneElement& element) {
  Vector3d sorted;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (corners[j] == element.particles[i]) sorted[i] = load.weights[j];
    }
  }
  return sorted;
}

}  // namespace

PointLoad checkedLoad(const PointLoad& load, std::size_t index, std::size_t triangle_count) {
  if (load.triangle < 0 || static_cast<std::size_t>(load.triangle) >= triangle_count) {
    base::refuse("point load ", index, ": triangle ", load.triangle,
                 " does not exist; the cloth has triangles 0 to ", triangle_count - 1);
  }
  if (!load.weights.allFinite() || !load.position.allFinite() || !load.force.allFinite() ||
      !load.stiffness.allFinite()) {
    base::refuse("point load ", index,
                 ": a number of its weights, position, force or stiffness is not finite");
  }
  if (!(std::abs(load.weights.sum() - 1.0) <= kTolerance)) {
    base::refuse("point load ", index, ": the weights sum to ", load.weights.sum(),
                 "; allowed is 1 within ", kTolerance);
  }
  const double norm = load.stiffness.norm();
  const double asymmetry = (load.stiffness - load.stiffness.transpose()).norm();
  if (!(asymmetry <= kTolerance * norm)) {
    base::refuse("point load ", index, ": the stiffness differs from its transpose by ", asymmetry,
                 " N/m; allowed is its norm, ", norm, " N/m, times ", kTolerance);
  }
  PointLoad checked = load;
  checked.stiffness = 0.5 * (load.stiffness + load.stiffness.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(checked.stiffness);
  const double smallest = solver.eigenvalues()[0];
  if (!(smallest >= -kTolerance * norm)) {
    base::refuse("point load ", index, ": the stiffness has the eigenvalue ", smallest,
                 " N/m; allowed are positive semidefinite matrices");
  }
  if (smallest < 0.0) {
    checked.stiffness = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                        solver.eigenvectors().transpose();
  }
  return checked;
}

PointLoads::PointLoads(const mesh::ClothMesh& mesh)
    : triangles_(mesh.triangles), elements_(restElements(mesh)) {
  loads_.reserve(kMax);
}

void PointLoads::set(const std::vector<PointLoad>& loads) {
  if (loads.size() > kMax) {
    throw std::invalid_argument("there are " + std::to_string(loads.size()) +
                                " point loads; allowed are " + std::to_string(kMax));
  }
  for (std::size_t i = 0; i < loads.size(); ++i) checkedLoad(loads[i], i, triangles_.size());
  loads_.clear();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    loads_.push_back(checkedLoad(loads[i], i, triangles_.size()));
  }
}

void PointLoads::bind(const linear::SymmetricBlockMatrix& matrix) {
  bindElements(matrix, elements_);
}

void PointLoads::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const PointLoad& load : loads_) {
    const Vector3d force = pointForce(load, triangles_, state.positions);
    for (int i = 0; i < 3; ++i) forces[triangles_[load.triangle][i]] += load.weights[i] * force;
  }
}

double PointLoads::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const PointLoad& load : loads_) {
    const Vector3d d = interpolated(load, triangles_, state.positions) - load.position;
    energy += d.dot(0.5 * load.stiffness * d - load.force);
  }
  return energy;
}

void PointLoads::addJacobian(const ForceState& /*state*/, JacobianRows& rows) const {
  for (const PointLoad& load : loads_) {
    const std::array<int, 3>& corners = triangles_[load.triangle];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        rows.add(corners[i], corners[j], -load.weights[i] * load.weights[j] * load.stiffness);
      }
    }
  }
}

void PointLoads::assembleLinearised(const ForceState& state, const StageTimes& times,
                                    linear::SymmetricBlockMatrix& matrix,
                                    linear::BlockVector& rhs) const {
  for (const PointLoad& load : loads_) {
    const MembraneElement& element = elements_[load.triangle];
    const Vector3d weights = sortedWeights(load, triangles_[load.triangle], element);
    const Vector3d impulse =
        times.a * (pointForce(load, triangles_, state.positions) -
                   times.ahead * load.stiffness * interpolated(load, triangles_, state.velocities));
    const Matrix3d stiffness = times.a * times.a * load.stiffness;
    for (int i = 0; i < 3; ++i) {
      rhs.col(element.particles[i]) += weights[i] * impulse;
      matrix.diagonal(element.particles[i]) += weights[i] * weights[i] * stiffness;
    }
    matrix.lower(element.slots[0]) += weights[1] * weights[0] * stiffness;
    matrix.lower(element.slots[1]) += weights[2] * weights[0] * stiffness;
    matrix.lower(element.slots[2]) += weights[2] * weights[1] * stiffness;
  }
}

}  // namespace haptex::cloth
