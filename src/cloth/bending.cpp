#include "haptex/cloth/bending.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "haptex/cloth/bending_stencils.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A direction in which a fabric does not resist bending at all is fitted as if it had this part of
/// the other's rigidity, to compare errors with something.
constexpr double kLeastRatio = 1e-6;
/// How much more an error of the weft's and warp's rigidity counts than one of twist or coupling.
constexpr double kEmphasis = 30.0;

void requireRigidity(const char* name, double value) {
  if (!std::isfinite(value) || value < 0.0) {
    std::ostringstream message;
    message << "the bending rigidity along " << name << " is " << value
            << " N.m; it must be finite and at least 0";
    throw std::invalid_argument(message.str());
  }
}

/// The entries of a symmetric matrix, so that their squares sum to the Frobenius norm's but for the
/// emphasis.
Eigen::VectorXd entriesOf(const Matrix3d& matrix) {
  Eigen::VectorXd entries(6);
  entries << kEmphasis * matrix(0, 0), kEmphasis * matrix(1, 1), matrix(2, 2),
      M_SQRT2 * matrix(0, 1), M_SQRT2 * matrix(0, 2), M_SQRT2 * matrix(1, 2);
  return entries;
}

/// Fits the stiffnesses of the stencils around one particle.
class Fit {
 public:
  explicit Fit(const material::BendingRigidity& rigidity) {
    const double largest = std::max(rigidity.weft, rigidity.warp);
    const double weft = std::max(rigidity.weft, kLeastRatio * largest);
    const double warp = std::max(rigidity.warp, kLeastRatio * largest);
    scale_ = Vector3d(std::sqrt(weft), std::sqrt(warp), std::sqrt(2.0 * std::sqrt(weft * warp)));
    wanted_ = Vector3d(rigidity.weft, rigidity.warp, 2.0 * std::sqrt(rigidity.weft * rigidity.warp))
                  .cwiseQuotient(scale_.cwiseAbs2());
  }

  /// Adds to the stiffnesses (N/m) of all stencils.
  void add(const std::vector<BendingStencil>& stencils, const BendingNeighbourhood& around,
           std::vector<double>& stiffnesses) const {
    // Stencils that resist the same. Lines through the particle, which come first, leave no part to
    // edges beside it: else rigidity would be smeared from one particle to the next.
    struct Group {
      Vector3d resists;
      std::vector<int> members;
    };
    std::vector<Group> groups;
    for (int index : around.stencils) {
      const Vector3d resists = scaled(stencils[index]).normalized();
      const bool line = stencils[index].centre >= 0;
      const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
        return std::abs(std::abs(group.resists.dot(resists)) - 1.0) < 1e-12;
      });
      if (same == groups.end()) {
        groups.push_back({resists, {index}});
      } else if (stencils[same->members.front()].centre < 0 || line) {
        same->members.push_back(index);
      }
    }
    Eigen::MatrixXd columns(6, groups.size());
    for (std::size_t i = 0; i < groups.size(); ++i) {
      columns.col(i) = entriesOf(groups[i].resists * groups[i].resists.transpose());
    }
    const Eigen::VectorXd fitted = nonNegativeLeastSquares(columns, entriesOf(target(around)));
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const double share = around.area * fitted[i] / groups[i].members.size();
      for (int index : groups[i].members) {
        stiffnesses[index] += share / scaled(stencils[index]).squaredNorm();
      }
    }
  }

 private:
  /// By curvatures times scale_: then an isotropic wish is the identity.
  Vector3d scaled(const BendingStencil& stencil) const {
    return stencil.resists.cwiseQuotient(scale_);
  }

  /// Without the curvature across free edges.
  Matrix3d target(const BendingNeighbourhood& around) const {
    Matrix3d result = wanted_.asDiagonal();
    for (const Vector2d& n : around.free_normals) {
      const Vector3d across =
          Vector3d(n.x() * n.x(), n.y() * n.y(), n.x() * n.y()).cwiseProduct(scale_);
      const Vector3d resisted = result * across;
      const double energy = across.dot(resisted);
      if (energy > 1e-9 * across.squaredNorm()) {
        result -= resisted * resisted.transpose() / energy;
      }
    }
    return result;
  }

  Vector3d scale_;
  Vector3d wanted_;
};

}  // namespace

Bending::Bending(const ClothMesh& mesh, const material::BendingRigidity& rigidity)
    : diagonal_(mesh.rest_coordinates.size(), 0.0) {
  requireRigidity("weft", rigidity.weft);
  requireRigidity("warp", rigidity.warp);
  if (rigidity.weft == 0.0 && rigidity.warp == 0.0) return;
  const BendingStencils found = findBendingStencils(mesh);
  std::vector<double> stiffnesses(found.stencils.size(), 0.0);
  const Fit fit(rigidity);
  for (const BendingNeighbourhood& around : found.neighbourhoods) {
    fit.add(found.stencils, around, stiffnesses);
  }
  std::map<std::array<int, 2>, double> couplings;
  for (std::size_t s = 0; s < stiffnesses.size(); ++s) {
    if (stiffnesses[s] <= 0.0) continue;
    const BendingStencil& stencil = found.stencils[s];
    hinges_.push_back({stencil.particles, stencil.weights, stiffnesses[s]});
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        const double product = stiffnesses[s] * stencil.weights[i] * stencil.weights[j];
        const auto [first, second] = std::minmax(stencil.particles[i], stencil.particles[j]);
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

void Bending::bind(const SymmetricBlockMatrix& matrix) {
  for (Coupling& coupling : couplings_) coupling.slot = matrix.slot(coupling.row, coupling.column);
}

void Bending::addForces(const Positions& positions, std::vector<Vector3d>& forces) const {
  for (const Coupling& coupling : couplings_) {
    const Vector3d force =
        coupling.stiffness * (positions[coupling.row] - positions[coupling.column]);
    forces[coupling.row] += force;
    forces[coupling.column] -= force;
  }
}

double Bending::energy(const Positions& positions) const {
  double energy = 0.0;
  for (const Hinge& hinge : hinges_) {
    const Vector3d& origin = positions[hinge.particles[0]];
    Vector3d bending = Vector3d::Zero();
    for (int i = 1; i < 4; ++i) {
      bending += hinge.weights[i] * (positions[hinge.particles[i]] - origin);
    }
    energy += 0.5 * hinge.stiffness * bending.squaredNorm();
  }
  return energy;
}

void Bending::addStep(const Positions& positions, const Velocities& velocities,
                      const StageTimes& times, SymmetricBlockMatrix& matrix,
                      BlockVector& rhs) const {
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
  for (int i = 0; i < matrix.size(); ++i) {
    matrix.diagonal(i).diagonal().array() += times.a * times.a * diagonal_[i];
  }
}

}  // namespace haptex::cloth
