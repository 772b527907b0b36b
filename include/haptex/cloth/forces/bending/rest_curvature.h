// Forces of bending of a sheet that is curved where no force acts on it.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "haptex/cloth/forces/bending/normal_hinges.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// A hinge whose bending vector b rests at r along the normal n of the present sheet
/// (NormalHinges), r = resists . (weft curvature, warp curvature, 0), has the energy
///   k |b - r n|^2 / 2 = k |b|^2 / 2 - k r b . n + k r^2 / 2.
/// The first part is the hinge's own (Bending), the others are added here.
class RestCurvature {
 public:
  /// @param curvature 1/m: BendingSettings::rest_curvature
  RestCurvature(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                const std::vector<HingeCorner>& corners, const Eigen::Vector2d& curvature);
  explicit RestCurvature(NormalHinges curved) : curved_(std::move(curved)) {}

  /// As Bending::renumber().
  void renumber(const std::vector<int>& particles) { curved_.renumber(particles); }

  double energy(const Positions& positions) const;  ///< J
  void addForces(const Positions& positions, std::vector<Eigen::Vector3d>& forces) const;
  /// Adds what it contributes to a linearised stage (Stage), rhs += a F(x + ahead v). The matrix
  /// does without: the Jacobian is not definite, and smaller than that of the hinges by the size of
  /// a cell over the radius.
  void assembleLinearised(const Positions& positions, const Velocities& velocities,
                          const StageTimes& times, linear::BlockVector& rhs) const;
  /// Adds the exact Jacobian of addForces().
  void addJacobian(const Positions& positions, JacobianRows& rows) const;

 private:
  NormalHinges curved_;
};

}  // namespace haptex::cloth
