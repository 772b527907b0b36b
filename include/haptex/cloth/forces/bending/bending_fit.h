// What bending is to resist at a place of a fabric, and stiffnesses of hinges that deliver it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "haptex/cloth/forces/bending/bending_stencils.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// A plate without transverse contraction, in second derivatives k = (wuu, wvv, wuv) times
/// scale(): energy per area k . target k / 2 is
///   (weft wuu^2 + warp wvv^2) / 2 + sqrt(weft warp) wuv^2,
/// and an isotropic fabric's target is the identity.
class PlateRigidity {
 public:
  /// @param rigidity finite, >= 0
  explicit PlateRigidity(const material::BendingRigidity& rigidity);
  /// A piece of several plates, which are bent alike: its energy per area is the mean of theirs.
  /// @param plates with their areas (m^2), at least one of which is > 0
  static PlateRigidity mean(const std::vector<std::pair<double, const PlateRigidity*>>& plates);

  const Eigen::Vector3d& scale() const { return scale_; }  ///< sqrt(N.m)
  /// Without the curvature across free edges, where no moment can act.
  /// @param free_normals unit length
  Eigen::Matrix3d target(const std::vector<Eigen::Vector2d>& free_normals) const;

 private:
  explicit PlateRigidity(const Eigen::Vector3d& resisted);

  Eigen::Vector3d resisted_;  // N.m, of wuu, wvv and wuv
  Eigen::Vector3d scale_;
  Eigen::Vector3d wanted_;
};

/// The plate at every triangle and particle of a sheet of several fabrics.
class PlateMap {
 public:
  /// One plate everywhere.
  explicit PlateMap(const material::BendingRigidity& rigidity) : plates_{PlateRigidity(rigidity)} {}
  /// @param rigidities of the fabrics that the triangles name
  PlateMap(const mesh::ClothMesh& sheet, const std::vector<material::BendingRigidity>& rigidities);

  const PlateRigidity& ofTriangle(std::size_t triangle) const {
    return plates_[triangles_.empty() ? 0 : triangles_[triangle]];
  }
  /// On the border of fabrics the mean of the triangles around.
  const PlateRigidity& ofParticle(std::size_t particle) const {
    return plates_[particles_.empty() ? 0 : particles_[particle]];
  }

 private:
  void addParticles(const mesh::ClothMesh& sheet);

  std::vector<PlateRigidity> plates_;       // of the fabrics, then of the particles on borders
  std::vector<int> triangles_, particles_;  // into plates_; empty: all are the first
};

/// The stiffnesses (N/m) of all stencils for which every particle's stencils resist what its area
/// is to, as near as stiffnesses >= 0 allow. Nothing if that is not exact at a particle inside of
/// the mesh.
std::optional<std::vector<double>> fitStiffnesses(const BendingStencils& found,
                                                  const PlateMap& plates);

}  // namespace haptex::cloth
