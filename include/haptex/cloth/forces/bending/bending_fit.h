// What bending is to resist at a place of a fabric, and stiffnesses of hinges that deliver it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/cloth/forces/bending/bending_stencils.h"
#include "haptex/material/fabric.h"

namespace haptex::cloth {

/// A plate without transverse contraction, in second derivatives k = (wuu, wvv, wuv) times
/// scale(): energy per area k . target k / 2 is
///   (weft wuu^2 + warp wvv^2) / 2 + sqrt(weft warp) wuv^2,
/// and an isotropic fabric's target is the identity.
class PlateRigidity {
 public:
  /// @param rigidity finite, >= 0, not both zero
  explicit PlateRigidity(const material::BendingRigidity& rigidity);

  const Eigen::Vector3d& scale() const { return scale_; }  ///< sqrt(N.m)
  /// Without the curvature across free edges, where no moment can act.
  /// @param free_normals unit length
  Eigen::Matrix3d target(const std::vector<Eigen::Vector2d>& free_normals) const;

 private:
  Eigen::Vector3d scale_;
  Eigen::Vector3d wanted_;
};

/// The stiffnesses (N/m) of all stencils for which every particle's stencils resist what its area
/// is to, as near as stiffnesses >= 0 allow. Nothing if that is not exact at a particle inside of
/// the mesh.
std::optional<std::vector<double>> fitStiffnesses(const BendingStencils& found,
                                                  const PlateRigidity& rigidity);

}  // namespace haptex::cloth
