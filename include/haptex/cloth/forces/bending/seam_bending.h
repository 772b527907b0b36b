// Bending over seams.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/bending/bending_hinge.h"
#include "haptex/cloth/forces/bending/rest_curvature.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// What the panels' own hinges (Bending) leave out along a seam, because an edge of a panel is
/// free: the bending across it of the triangles on either side. With the image d of the unit vector
/// from the seam into each triangle, b = d_1 + d_2 is zero in every flat state and has the length
/// 2 sin(theta / 2) where the triangles are turned against each other by theta. Each has the
/// rigidity D across the seam on half of its height H, so the two in series have the energy per
/// length
///   |b|^2 / (H_1 / D_1 + H_2 / D_2),
/// which for a sheet in one piece is that of its curvature on the triangles' areas. A seam with the
/// angle a at rest has |b - 2 sin(a / 2) n|^2 in place of |b|^2 (RestCurvature).
///
/// The edges' particles need not match: there is one hinge for every two triangles that meet along
/// the seam, and it weighs by the length that they share. Where they do match, a strip across the
/// seam bends as one without a seam.
class SeamBending final : public Force {
 public:
  /// @param mesh without defects
  /// @param rigidities of the fabrics that the triangles name
  /// @throws std::invalid_argument if a rigidity is not finite and >= 0, or a hinge has a triangle
  ///   that does not exist or a number that is not finite
  SeamBending(const mesh::ClothMesh& mesh,
              const std::vector<material::BendingRigidity>& rigidities);

  /// Makes it one on some particles of a larger mesh. Before bind().
  /// @param particles of that mesh, for every one of this, ascending
  void renumber(const std::vector<int>& particles);

  const std::vector<Hinge>& hinges() const { return hinges_; }
  const std::vector<HingeCorner>& corners() const { return corners_; }

  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  /// K is without the part of an angle at rest (RestCurvature::assembleLinearised()).
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

 private:
  struct Angles;
  void addHinge(const mesh::ClothMesh& mesh, const mesh::SeamHinge& seam, double stiffness,
                Angles& angles);
  template <typename Place>
  Eigen::Vector3d bendingVector(const Hinge& hinge, const Place& place) const;

  std::vector<Hinge> hinges_;
  std::vector<HingeCorner> corners_;
  std::vector<int> slots_;  // of the pairs of a hinge's corners, one hinge after the other
  std::optional<RestCurvature> rest_;
};

}  // namespace haptex::cloth
