#include "haptex/cloth/forces/bending/bending_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

// A stencil with stiffness k resists the second derivatives in one direction s of (wuu, wvv, wuv):
// energy k (s . w)^2 / 2. What a particle's stencils resist together is the sum of k s s^T over its
// area, a symmetric 3x3 matrix, and the plate wants PlateRigidity::target() there. So every
// particle asks for
//   k >= 0 that minimise || sum k s s^T - area target ||,
// six equations for a few stencils: a non-negative least-squares problem (Lawson and Hanson,
// Solving Least Squares Problems, 1974, chapter 23). Steps of fitStiffnesses(), for each particle:
//   1. scale the derivatives, so that an isotropic plate's target is the identity;
//   2. groupsOf(): stencils in the same direction cannot be told apart; they share one unknown;
//   3. nonNegativeLeastSquares() for the groups;
//   4. addFitted(): a group's stiffness goes to its members in equal shares. A stencil that two
//      particles use adds up what both ask for.
namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A direction in which a fabric does not resist bending at all is fitted as if it had this part of
/// the other's rigidity, to compare errors with something.
constexpr double kMinRatio = 1e-6;
/// How much more an error of the weft's and warp's rigidity counts than one of twist or coupling.
constexpr double kEmphasis = 30.0;
/// Rounding leaves 1e-12 of the target on grids; the least irregular meshes leave 1e-2.
constexpr double kExact = 1e-6;

/// The entries of a symmetric matrix, so that their squares sum to the Frobenius norm's but for the
/// emphasis.
Eigen::VectorXd entriesOf(const Matrix3d& matrix) {
  Eigen::VectorXd entries(6);
  entries << kEmphasis * matrix(0, 0), kEmphasis * matrix(1, 1), matrix(2, 2),
      M_SQRT2 * matrix(0, 1), M_SQRT2 * matrix(0, 2), M_SQRT2 * matrix(1, 2);
  return entries;
}

/// Stencils that resist the same.
struct Group {
  Vector3d resists;
  std::vector<int> members;
};

/// Lines through the particle, which come first, leave no part to edges beside them: else rigidity
/// would be smeared from one particle to the next.
std::vector<Group> groupsOf(const BendingStencils& found, const BendingNeighbourhood& around,
                            const Vector3d& scale) {
  std::vector<Group> groups;
  for (int index : around.stencils) {
    const BendingStencil& stencil = found.stencils[index];
    const Vector3d resists = stencil.resists.cwiseQuotient(scale).normalized();
    const bool line = stencil.centre >= 0;
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return std::abs(std::abs(group.resists.dot(resists)) - 1.0) < 1e-12;
    });
    if (same == groups.end()) {
      groups.push_back({resists, {index}});
    } else if (found.stencils[same->members.front()].centre < 0 || line) {
      same->members.push_back(index);
    }
  }
  return groups;
}

/// Adds what one particle asks for; false if it is not delivered exactly.
bool addFitted(const BendingStencils& found, const BendingNeighbourhood& around,
               const PlateRigidity& rigidity, std::vector<double>& stiffnesses) {
  const std::vector<Group> groups = groupsOf(found, around, rigidity.scale());
  Eigen::MatrixXd columns(6, groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) {
    columns.col(i) = entriesOf(groups[i].resists * groups[i].resists.transpose());
  }
  const Eigen::VectorXd target = entriesOf(rigidity.target(around.free_normals));
  const Eigen::VectorXd fitted = nonNegativeLeastSquares(columns, target);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double share = around.area * fitted[i] / groups[i].members.size();
    for (int index : groups[i].members) {
      stiffnesses[index] +=
          share / found.stencils[index].resists.cwiseQuotient(rigidity.scale()).squaredNorm();
    }
  }
  return (columns * fitted - target).norm() <= kExact * target.norm();
}

}  // namespace

PlateRigidity::PlateRigidity(const material::BendingRigidity& rigidity)
    : PlateRigidity(
          Vector3d(rigidity.weft, rigidity.warp, 2.0 * std::sqrt(rigidity.weft * rigidity.warp))) {}

PlateRigidity::PlateRigidity(const Vector3d& resisted)
    : resisted_(resisted), scale_(Vector3d::Ones()), wanted_(Vector3d::Zero()) {
  const double largest = std::max(resisted[0], resisted[1]);
  if (largest == 0.0) return;  // nothing is resisted, in whatever units
  const double weft = std::max(resisted[0], kMinRatio * largest);
  const double warp = std::max(resisted[1], kMinRatio * largest);
  scale_ = Vector3d(std::sqrt(weft), std::sqrt(warp), std::sqrt(2.0 * std::sqrt(weft * warp)));
  wanted_ = resisted_.cwiseQuotient(scale_.cwiseAbs2());
}

PlateRigidity PlateRigidity::mean(
    const std::vector<std::pair<double, const PlateRigidity*>>& plates) {
  Vector3d sum = Vector3d::Zero();
  double areas = 0.0;
  for (const auto& [area, plate] : plates) {
    sum += area * plate->resisted_;
    areas += area;
  }
  return PlateRigidity(Vector3d(sum / areas));
}

PlateMap::PlateMap(const mesh::ClothMesh& sheet,
                   const std::vector<material::BendingRigidity>& rigidities) {
  for (const material::BendingRigidity& rigidity : rigidities) plates_.emplace_back(rigidity);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    triangles_.push_back(sheet.fabricOf(t));
  }
  addParticles(sheet);
}

void PlateMap::addParticles(const mesh::ClothMesh& sheet) {
  std::vector<std::vector<int>> around(sheet.rest_coordinates.size());
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    for (const int particle : sheet.triangles[t]) around[particle].push_back(static_cast<int>(t));
  }
  const std::size_t fabrics = plates_.size();
  plates_.reserve(fabrics + around.size());
  for (const std::vector<int>& triangles : around) {
    std::set<int> met;
    for (const int triangle : triangles) met.insert(triangles_[triangle]);
    if (met.size() == 1) {
      particles_.push_back(*met.begin());
      continue;
    }
    std::vector<std::pair<double, const PlateRigidity*>> parts;
    for (const int triangle : triangles) {
      const std::array<Eigen::Vector2d, 3> corners = sheet.restCorners(triangle);
      Eigen::Matrix2d edges;
      edges << corners[1] - corners[0], corners[2] - corners[0];
      parts.emplace_back(std::abs(edges.determinant()), &plates_[triangles_[triangle]]);
    }
    particles_.push_back(static_cast<int>(plates_.size()));
    plates_.push_back(PlateRigidity::mean(parts));
  }
}

Matrix3d PlateRigidity::target(const std::vector<Eigen::Vector2d>& free_normals) const {
  Matrix3d result = wanted_.asDiagonal();
  // No moment acts across a free edge, so that the curvature there is what costs no energy: the
  // target is reduced by what that curvature relaxes (a Schur complement).
  for (const Eigen::Vector2d& n : free_normals) {
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

std::optional<std::vector<double>> fitStiffnesses(const BendingStencils& found,
                                                  const PlateMap& plates) {
  std::vector<double> stiffnesses(found.stencils.size(), 0.0);
  for (std::size_t i = 0; i < found.neighbourhoods.size(); ++i) {
    const BendingNeighbourhood& around = found.neighbourhoods[i];
    const bool exact = addFitted(found, around, plates.ofParticle(i), stiffnesses);
    if (!exact && around.free_normals.empty()) return std::nullopt;
  }
  return stiffnesses;
}

}  // namespace haptex::cloth
