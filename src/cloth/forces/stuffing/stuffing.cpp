#include "haptex/cloth/forces/stuffing/stuffing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "haptex/base/disjoint_sets.h"
#include "haptex/base/require.h"
#include "haptex/cloth/forces/cross_matrix.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void requireSound(const StuffingMass& mass) {
  const auto require = [](const char* name, double value) {
    base::require(std::isfinite(value) && value > 0.0, "stuffing", name, value, "finite and > 0");
  };
  require("volume", mass.volume);
  require("modulus", mass.modulus);
}

/// m^2, of a triangle, along its normal.
Vector3d areaVector(const std::array<int, 3>& triangle, const Positions& positions) {
  const Vector3d& a = positions[triangle[0]];
  return 0.5 * (positions[triangle[1]] - a).cross(positions[triangle[2]] - a);
}

}  // namespace

StuffingPressure pressureOf(const StuffingMass& mass, double volume) {
  if (!(volume < mass.volume)) return {0.0, 0.0, 0.0};
  const double at = std::max(volume, kLeastVolume * mass.volume);
  const double ratio = mass.volume / at, cube = ratio * ratio * ratio;
  StuffingPressure result;
  result.pressure = mass.modulus * (cube - 1.0);
  result.slope = 3.0 * mass.modulus * cube / at;
  result.energy = mass.modulus * (0.5 * mass.volume * (ratio * ratio - 1.0) - (mass.volume - at));
  if (volume < at) {
    const double beyond = at - volume;
    result.energy += beyond * (result.pressure + 0.5 * beyond * result.slope);
    result.pressure += beyond * result.slope;
  }
  return result;
}

/// Seen from a particle, so that places far from the origin cost no digits.
double enclosedVolume(const std::vector<std::array<int, 3>>& triangles,
                      const Positions& positions) {
  const Vector3d& from = positions[triangles.front()[0]];
  double volume = 0.0;
  for (const std::array<int, 3>& triangle : triangles) {
    volume += areaVector(triangle, positions).dot(positions[triangle[0]] - from) / 3.0;
  }
  return volume;
}

Stuffing::Stuffing(const mesh::ClothMesh& mesh, const StuffingMass& mass)
    : mass_(mass),
      triangles_(mesh.triangles),
      derivative_(3, static_cast<Eigen::Index>(mesh.initial_positions.size())) {
  requireSound(mass);
  findEdges();
  requireOnePiece(mesh.initial_positions.size());
  const double volume = enclosedVolume(triangles_, mesh.initial_positions);
  if (volume >= kLeastStart * mass.volume) return;
  base::refuse("the stuffing of ", base::shortNumber(mass.volume),
               " m^3 is in cloth that encloses ", base::shortNumber(volume),
               " m^3 at the start: allowed is ", base::shortNumber(kLeastStart),
               " of it at least, with triangles that run counter-clockwise as seen from outside");
}

void Stuffing::findEdges() {
  std::map<std::array<int, 2>, int> opposite;  // of each edge as its triangle runs
  const auto refuse = [&](const std::array<int, 2>& edge, const char* what) {
    base::refuse("the stuffing needs a closed cloth, and the edge of particles ", edge[0], " and ",
                 edge[1], what);
  };
  for (const auto& t : triangles_) {
    for (int i = 0; i < 3; ++i) {
      const std::array<int, 2> edge = {t[i], t[(i + 1) % 3]};
      if (!opposite.emplace(edge, t[(i + 2) % 3]).second) {
        refuse(edge, " is run through the same way by two triangles");
      }
    }
  }
  for (const auto& [edge, first] : opposite) {
    const auto other = opposite.find({edge[1], edge[0]});
    if (other == opposite.end()) refuse(edge, " has one triangle");
    if (edge[0] < edge[1]) edges_.push_back({edge, {first, other->second}, -1});
  }
}

void Stuffing::requireOnePiece(std::size_t particles) const {
  base::DisjointSets pieces(particles);
  for (const InnerEdge& edge : edges_) pieces.join(edge.ends[0], edge.ends[1]);
  const int first = pieces.root(triangles_.front()[0]);
  for (const auto& triangle : triangles_) {
    if (pieces.root(triangle[0]) == first) continue;
    base::refuse("the stuffing needs one closed cloth, and particle ", triangle[0],
                 " is of another one than particle ", triangles_.front()[0]);
  }
}

void Stuffing::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (InnerEdge& edge : edges_) {
    edge.slot = matrix.slot(edge.ends[1], edge.ends[0]);
  }
}

StuffingPressure Stuffing::pressure(const Positions& positions) const {
  return pressureOf(mass_, enclosedVolume(triangles_, positions));
}

const linear::BlockVector& Stuffing::derivative(const Positions& positions) const {
  derivative_.setZero();
  for (const auto& triangle : triangles_) {
    const Vector3d third = areaVector(triangle, positions) / 3.0;
    for (const int particle : triangle) derivative_.col(particle) += third;
  }
  return derivative_;
}

/// m, derivative of the volume's derivative by the place of ends[0] by that of ends[1]. That by its
/// own place is zero.
Matrix3d Stuffing::turning(const InnerEdge& edge, const Positions& positions) {
  return crossMatrix((positions[edge.opposite[1]] - positions[edge.opposite[0]]) / 6.0);
}

void Stuffing::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  const double pressure = this->pressure(state.positions).pressure;
  if (pressure == 0.0) return;
  for (const auto& triangle : triangles_) {
    const Vector3d third = pressure / 3.0 * areaVector(triangle, state.positions);
    for (const int particle : triangle) forces[particle] += third;
  }
}

double Stuffing::energy(const ForceState& state) const { return pressure(state.positions).energy; }

void Stuffing::addJacobian(const ForceState& state, JacobianRows& rows) const {
  const StuffingPressure at = pressure(state.positions);
  const linear::BlockVector& by_place = derivative(state.positions);
  for (int row = 0; row < by_place.cols(); ++row) {
    if (at.slope == 0.0 || !rows.asksFor(row)) continue;
    for (int column = 0; column < by_place.cols(); ++column) {
      rows.add(row, column, -at.slope * by_place.col(row) * by_place.col(column).transpose());
    }
  }
  for (const InnerEdge& edge : edges_) {
    const Matrix3d block = at.pressure * turning(edge, state.positions);
    rows.add(edge.ends[0], edge.ends[1], block);
    rows.add(edge.ends[1], edge.ends[0], block.transpose());
  }
}

void Stuffing::assembleLinearised(const ForceState& state, const StageTimes& times,
                                  linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const {
  const StuffingPressure at = pressure(state.positions);
  if (at.pressure == 0.0) return;
  const linear::BlockVector& by_place = derivative(state.positions);
  double rate = 0.0;  // m^3/s, of the volume
  for (int i = 0; i < by_place.cols(); ++i) rate += by_place.col(i).dot(state.velocities[i]);
  rhs += times.a * (at.pressure - times.ahead * at.slope * rate) * by_place;
  matrix.setOuterProduct(times.a * times.a * at.slope, by_place);
}

void Stuffing::assembleNewton(const ForceState& state, const Vector3d* /*held*/, double a,
                              Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const {
  assembleLinearised(state, {a, 0.0}, matrix, rhs);
  if (hessian == Hessian::kProjected) return;
  const double scale = -a * a * pressure(state.positions).pressure;
  for (const InnerEdge& edge : edges_) {
    matrix.lower(edge.slot) += scale * turning(edge, state.positions).transpose();
  }
}

}  // namespace haptex::cloth
