#include "haptex/cloth/forces/bending/seam_bending.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

void requireSound(const mesh::ClothMesh& mesh, const mesh::SeamHinge& seam) {
  for (const int triangle : seam.triangles) {
    if (triangle >= 0 && triangle < static_cast<int>(mesh.triangles.size())) continue;
    base::refuse("a hinge of a seam is between the triangles ", seam.triangles[0], " and ",
                 seam.triangles[1], "; the mesh has triangles 0 to ", mesh.triangles.size() - 1);
  }
  bool finite = std::isfinite(seam.length) && std::isfinite(seam.angle);
  for (int i = 0; i < 2; ++i) {
    finite = finite && seam.along[i].allFinite() && seam.inward[i].allFinite();
  }
  if (finite && seam.length > 0.0) return;
  base::refuse("the hinge of a seam between the triangles ", seam.triangles[0], " and ",
               seam.triangles[1], " has the length ", seam.length, " m and the angle ", seam.angle,
               " rad; numbers must be finite and the length greater than 0");
}

/// N.m, of a fabric that is bent along a direction: energy per area is that times the square of the
/// curvature over 2 (PlateRigidity).
double rigidityAlong(const material::BendingRigidity& rigidity, const Vector2d& direction) {
  for (const double value : {rigidity.weft, rigidity.warp}) {
    if (std::isfinite(value) && value >= 0.0) continue;
    base::refuse("the bending rigidity of a fabric is ", value,
                 " N.m; it must be finite and at least 0");
  }
  const double root = std::sqrt(rigidity.weft) * direction.x() * direction.x() +
                      std::sqrt(rigidity.warp) * direction.y() * direction.y();
  return root * root;
}

/// m
double heightAcross(const std::array<Vector2d, 3>& corners, const Vector2d& inward) {
  const auto [least, most] =
      std::minmax({corners[0].dot(inward), corners[1].dot(inward), corners[2].dot(inward)});
  return most - least;
}

/// 1/m, by corner: sum of weight P is the image of the unit vector along a direction.
Vector3d derivativeAlong(const std::array<Vector2d, 3>& corners, const Vector2d& direction) {
  Eigen::Matrix2d edges;
  edges << corners[1] - corners[0], corners[2] - corners[0];
  const Vector2d weights = edges.inverse() * direction;
  return {-weights.sum(), weights[0], weights[1]};
}

}  // namespace

/// Hinges with an angle at rest.
struct SeamBending::Angles {
  std::vector<NormalHinges::NormalHinge> hinges;
  std::vector<NormalHinges::Corner> corners;
};

SeamBending::SeamBending(const mesh::ClothMesh& mesh,
                         const std::vector<material::BendingRigidity>& rigidities) {
  Angles angles;
  for (const mesh::SeamHinge& seam : mesh.seam_hinges) {
    requireSound(mesh, seam);
    double compliance = 0.0;  // rad/N: of the moment per length
    for (int i = 0; i < 2; ++i) {
      const double rigidity =
          rigidityAlong(rigidities[mesh.fabricOf(seam.triangles[i])], seam.inward[i]);
      compliance +=
          0.5 * heightAcross(mesh.restCorners(seam.triangles[i]), seam.inward[i]) / rigidity;
    }
    if (std::isfinite(compliance)) addHinge(mesh, seam, seam.length / compliance, angles);
  }
  if (angles.hinges.empty()) return;
  rest_.emplace(NormalHinges(std::move(angles.hinges), std::move(angles.corners)));
}

/// The normal of an angle at rest is that of U along the seam and V = (d_1 - d_2) / 2 across it, on
/// which b stands upright.
void SeamBending::addHinge(const mesh::ClothMesh& mesh, const mesh::SeamHinge& seam,
                           double stiffness, Angles& angles) {
  std::vector<NormalHinges::Corner> corners;
  for (int side = 0; side < 2; ++side) {
    const int triangle = seam.triangles[side];
    const std::array<Vector2d, 3> rest = mesh.restCorners(triangle);
    const Vector3d inward = derivativeAlong(rest, seam.inward[side]);
    const Vector3d along = derivativeAlong(rest, seam.along[side]);
    for (int i = 0; i < 3; ++i) {
      const int particle = mesh.triangles[triangle][i];
      auto corner = std::find_if(corners.begin(), corners.end(),
                                 [&](const auto& one) { return one.particle == particle; });
      if (corner == corners.end()) corner = corners.insert(corner, {particle, 0.0, 0.0, 0.0});
      corner->weight += inward[i];
      corner->weft += 0.5 * along[i];
      corner->warp += (side == 0 ? 0.5 : -0.5) * inward[i];
    }
  }
  const int begin = static_cast<int>(corners_.size());
  for (const auto& corner : corners) corners_.push_back({corner.particle, corner.weight});
  hinges_.push_back({begin, static_cast<int>(corners_.size()), stiffness, Vector3d::Zero()});
  if (seam.angle == 0.0) return;
  const Vector2d &along = seam.along[0], &inward = seam.inward[0];
  const bool mirrored = along.x() * inward.y() - along.y() * inward.x() < 0.0;
  const double bend = 2.0 * std::sin(0.5 * seam.angle) * (mirrored ? -1.0 : 1.0);
  const int first = static_cast<int>(angles.corners.size());
  angles.corners.insert(angles.corners.end(), corners.begin(), corners.end());
  angles.hinges.push_back({first, static_cast<int>(angles.corners.size()), stiffness, bend, 0.0});
}

void SeamBending::renumber(const std::vector<int>& particles) {
  for (HingeCorner& corner : corners_) corner.particle = particles[corner.particle];
  if (rest_) rest_->renumber(particles);
}

template <typename Place>
Vector3d SeamBending::bendingVector(const Hinge& hinge, const Place& place) const {
  const Vector3d origin = place(corners_[hinge.begin].particle);
  Vector3d bending = Vector3d::Zero();
  for (int i = hinge.begin + 1; i < hinge.end; ++i) {
    bending += corners_[i].weight * (place(corners_[i].particle) - origin);
  }
  return bending;
}

std::vector<std::array<int, 2>> SeamBending::pairs() const {
  std::vector<std::array<int, 2>> pairs;
  for (const Hinge& hinge : hinges_) {
    for (int i = hinge.begin; i < hinge.end; ++i) {
      for (int j = hinge.begin; j < i; ++j) {
        const auto [first, second] = std::minmax(corners_[i].particle, corners_[j].particle);
        pairs.push_back({first, second});
      }
    }
  }
  return pairs;
}

void SeamBending::bind(const linear::SymmetricBlockMatrix& matrix) {
  slots_.clear();
  for (const auto& [first, second] : pairs()) slots_.push_back(matrix.slot(second, first));
}

void SeamBending::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const Hinge& hinge : hinges_) {
    const Vector3d force =
        hinge.stiffness * bendingVector(hinge, [&](int i) { return state.positions[i]; });
    for (int i = hinge.begin; i < hinge.end; ++i) {
      forces[corners_[i].particle] -= corners_[i].weight * force;
    }
  }
  if (rest_) rest_->addForces(state.positions, forces);
}

double SeamBending::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const Hinge& hinge : hinges_) {
    energy += 0.5 * hinge.stiffness *
              bendingVector(hinge, [&](int i) { return state.positions[i]; }).squaredNorm();
  }
  if (rest_) energy += rest_->energy(state.positions);
  return energy;
}

void SeamBending::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (const Hinge& hinge : hinges_) {
    for (int i = hinge.begin; i < hinge.end; ++i) {
      for (int j = hinge.begin; j < hinge.end; ++j) {
        rows.add(corners_[i].particle, corners_[j].particle,
                 -hinge.stiffness * corners_[i].weight * corners_[j].weight * Matrix3d::Identity());
      }
    }
  }
  if (rest_) rest_->addJacobian(state.positions, rows);
}

void SeamBending::assembleLinearised(const ForceState& state, const StageTimes& times,
                                     linear::SymmetricBlockMatrix& matrix,
                                     linear::BlockVector& rhs) const {
  std::size_t pair = 0;
  for (const Hinge& hinge : hinges_) {
    // F(x) + ahead K v = F(x + ahead v), because the forces are linear.
    const Vector3d impulse =
        times.a * hinge.stiffness * bendingVector(hinge, [&](int i) -> Vector3d {
          return state.positions[i] + times.ahead * state.velocities[i];
        });
    const double stiffness = times.a * times.a * hinge.stiffness;
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const double weight = corners_[i].weight;
      rhs.col(corners_[i].particle) -= weight * impulse;
      matrix.diagonal(corners_[i].particle).diagonal().array() += stiffness * weight * weight;
      for (int j = hinge.begin; j < i; ++j) {
        matrix.lower(slots_[pair++]).diagonal().array() += stiffness * weight * corners_[j].weight;
      }
    }
  }
  if (rest_) rest_->assembleLinearised(state.positions, state.velocities, times, rhs);
}

}  // namespace haptex::cloth
