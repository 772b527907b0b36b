#include "haptex/cloth/forces/bending/bending.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "haptex/cloth/forces/bending/bending_moments.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void requireRigidity(const char* name, double value) {
  if (!std::isfinite(value) || value < 0.0) {
    std::ostringstream message;
    message << "the bending rigidity along " << name << " is " << value
            << " N.m; it must be finite and at least 0";
    throw std::invalid_argument(message.str());
  }
}

const std::vector<material::BendingRigidity>& required(
    const std::vector<material::BendingRigidity>& rigidities) {
  for (const material::BendingRigidity& rigidity : rigidities) {
    requireRigidity("weft", rigidity.weft);
    requireRigidity("warp", rigidity.warp);
  }
  return rigidities;
}

}  // namespace

Bending::Bending(const mesh::ClothMesh& mesh, const material::BendingRigidity& rigidity,
                 const BendingSettings& settings)
    : Bending(mesh, {rigidity}, PlateMap(required({rigidity}).front()), settings) {}

Bending::Bending(const mesh::ClothMesh& mesh,
                 const std::vector<material::BendingRigidity>& rigidities,
                 const BendingSettings& settings)
    : Bending(mesh, rigidities, PlateMap(mesh, required(rigidities)), settings) {}

Bending::Bending(const mesh::ClothMesh& mesh,
                 const std::vector<material::BendingRigidity>& rigidities, const PlateMap& plates,
                 const BendingSettings& settings)
    : model_(settings.model), diagonal_(mesh.rest_coordinates.size(), 0.0) {
  if (!settings.rest_curvature.allFinite()) {
    throw std::invalid_argument("the rest curvature has a component that is not finite");
  }
  if (std::all_of(rigidities.begin(), rigidities.end(), [](const auto& rigidity) {
        return rigidity.weft == 0.0 && rigidity.warp == 0.0;
      })) {
    return;
  }
  std::optional<std::vector<double>> stiffnesses;
  if (settings.model == BendingModel::kLinear) {
    const BendingStencils found = findBendingStencils(mesh);
    stiffnesses = fitStiffnesses(found, plates);
    if (stiffnesses) addFittedHinges(found, *stiffnesses);
  }
  if (!stiffnesses) {
    model_ = BendingModel::kQuadratic;
    addCurvatureHinges(mesh, plates);
  }
  couple(mesh);
  if (!settings.rest_curvature.isZero(0.0)) {
    rest_.emplace(mesh, hinges_, corners_, settings.rest_curvature);
  }
}

void Bending::addFittedHinges(const BendingStencils& found,
                              const std::vector<double>& stiffnesses) {
  for (std::size_t s = 0; s < stiffnesses.size(); ++s) {
    if (stiffnesses[s] <= 0.0) continue;
    const BendingStencil& stencil = found.stencils[s];
    const int begin = static_cast<int>(corners_.size());
    for (int i = 0; i < 4; ++i) corners_.push_back({stencil.particles[i], stencil.weights[i]});
    hinges_.push_back({begin, begin + 4, stiffnesses[s], stencil.resists});
  }
}

/// The target of every triangle is a sum of squares: each becomes a hinge. Its weights are those of
/// the curvature times the triangle's area.
void Bending::addCurvatureHinges(const mesh::ClothMesh& mesh, const PlateMap& plates) {
  constexpr double kLeast = 1e-12;  // of an isotropic fabric's target, which is 1
  const std::vector<CurvatureStencil> stencils = findCurvatureStencils(mesh);
  for (std::size_t t = 0; t < stencils.size(); ++t) {
    const CurvatureStencil& stencil = stencils[t];
    const PlateRigidity& rigidity = plates.ofTriangle(t);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> parts(rigidity.target(stencil.free_normals));
    for (int i = 0; i < 3; ++i) {
      const double part = parts.eigenvalues()[i];
      if (part < kLeast) continue;
      const Vector3d resists = stencil.area *
                               rigidity.scale().cwiseProduct(parts.eigenvectors().col(i)) /
                               rigidity.scale().maxCoeff();
      const Eigen::RowVectorXd weights = resists.transpose() * stencil.weights;
      const int begin = static_cast<int>(corners_.size());
      for (std::size_t j = 0; j < stencil.particles.size(); ++j) {
        corners_.push_back({stencil.particles[j], weights[static_cast<Eigen::Index>(j)]});
      }
      const double stiffness = part * std::pow(rigidity.scale().maxCoeff(), 2) / stencil.area;
      hinges_.push_back({begin, static_cast<int>(corners_.size()), stiffness, resists});
    }
  }
}

/// Sums up what the hinges do between each two particles.
void Bending::couple(const mesh::ClothMesh& mesh) {
  std::map<std::array<int, 2>, double> couplings;
  for (const Hinge& hinge : hinges_) {
    for (int i = hinge.begin; i < hinge.end; ++i) {
      for (int j = hinge.begin; j < i; ++j) {
        const double product = hinge.stiffness * corners_[i].weight * corners_[j].weight;
        const auto [first, second] = std::minmax(corners_[i].particle, corners_[j].particle);
        if (product != 0.0) couplings[{first, second}] += product;
      }
    }
  }
  std::set<std::array<int, 2>> edges;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto [first, second] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.insert({first, second});
    }
  }
  for (const auto& [pair, stiffness] : couplings) {
    couplings_.push_back({pair[1], pair[0], -1, stiffness});
    diagonal_[pair[0]] -= stiffness;
    diagonal_[pair[1]] -= stiffness;
    if (edges.count(pair) == 0) pairs_.push_back(pair);
  }
}

void Bending::renumber(const std::vector<int>& particles) {
  for (HingeCorner& corner : corners_) corner.particle = particles[corner.particle];
  std::vector<double> diagonal(particles.back() + 1, 0.0);
  for (std::size_t i = 0; i < particles.size(); ++i) diagonal[particles[i]] += diagonal_[i];
  std::vector<Coupling> couplings;
  for (Coupling coupling : couplings_) {
    // Particles of the sheet that were sewn together are in no order, or one.
    std::tie(coupling.column, coupling.row) =
        std::minmax({particles[coupling.row], particles[coupling.column]});
    if (coupling.row != coupling.column) {
      couplings.push_back(coupling);
    } else {
      diagonal[coupling.row] += 2.0 * coupling.stiffness;
    }
  }
  couplings_ = std::move(couplings);
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [a, b] : pairs_) {
    const auto [first, second] = std::minmax({particles[a], particles[b]});
    if (first != second) pairs.push_back({first, second});
  }
  pairs_ = std::move(pairs);
  diagonal_ = std::move(diagonal);
  if (rest_) rest_->renumber(particles);
}

void Bending::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (Coupling& coupling : couplings_) coupling.slot = matrix.slot(coupling.row, coupling.column);
}

void Bending::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  const Positions& positions = state.positions;
  for (const Coupling& coupling : couplings_) {
    const Vector3d force =
        coupling.stiffness * (positions[coupling.row] - positions[coupling.column]);
    forces[coupling.row] += force;
    forces[coupling.column] -= force;
  }
  if (rest_) rest_->addForces(positions, forces);
}

double Bending::energy(const ForceState& state) const {
  const Positions& positions = state.positions;
  double energy = 0.0;
  for (const Hinge& hinge : hinges_) {
    const Vector3d& origin = positions[corners_[hinge.begin].particle];
    Vector3d bending = Vector3d::Zero();
    for (int i = hinge.begin + 1; i < hinge.end; ++i) {
      bending += corners_[i].weight * (positions[corners_[i].particle] - origin);
    }
    energy += 0.5 * hinge.stiffness * bending.squaredNorm();
  }
  if (rest_) energy += rest_->energy(positions);
  return energy;
}

void Bending::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (const Coupling& coupling : couplings_) {
    if (!rows.asksFor(coupling.row) && !rows.asksFor(coupling.column)) continue;
    const Matrix3d block = coupling.stiffness * Matrix3d::Identity();
    for (const auto& [row, column] :
         {std::pair(coupling.row, coupling.column), std::pair(coupling.column, coupling.row)}) {
      rows.add(row, row, block);
      rows.add(row, column, -block);
    }
  }
  if (rest_) rest_->addJacobian(state.positions, rows);
}

void Bending::assembleLinearised(const ForceState& state, const StageTimes& times,
                                 linear::SymmetricBlockMatrix& matrix,
                                 linear::BlockVector& rhs) const {
  const Positions& positions = state.positions;
  const Velocities& velocities = state.velocities;
  // F(x) + ahead K v = F(x + ahead v), because the forces are linear.
  for (const Coupling& coupling : couplings_) {
    const Vector3d difference =
        positions[coupling.row] - positions[coupling.column] +
        times.ahead * (velocities[coupling.row] - velocities[coupling.column]);
    const Vector3d impulse = times.a * coupling.stiffness * difference;
    rhs.col(coupling.row) += impulse;
    rhs.col(coupling.column) -= impulse;
    matrix.lower(coupling.slot).diagonal().array() += times.a * times.a * coupling.stiffness;
  }
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    matrix.diagonal(static_cast<int>(i)).diagonal().array() += times.a * times.a * diagonal_[i];
  }
  if (rest_) rest_->assembleLinearised(positions, velocities, times, rhs);
}

}  // namespace haptex::cloth
