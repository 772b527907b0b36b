#include "haptex/cloth/forces/bending/rest_curvature.h"

namespace haptex::cloth {

using Eigen::Vector2d;
using Eigen::Vector3d;

RestCurvature::RestCurvature(const mesh::ClothMesh& mesh, const std::vector<Hinge>& hinges,
                             const std::vector<HingeCorner>& corners, const Vector2d& curvature)
    : curved_(mesh, hinges, corners, curvature) {}

double RestCurvature::energy(const Positions& positions) const {
  double energy = 0.0;
  for (const NormalHinges::NormalHinge& hinge : curved_.hinges()) {
    const double bend = curved_.frame(hinge, positions).bend();
    energy += hinge.stiffness * hinge.bend * (0.5 * hinge.bend - bend);
  }
  return energy;
}

void RestCurvature::addForces(const Positions& positions, std::vector<Vector3d>& forces) const {
  for (const NormalHinges::NormalHinge& hinge : curved_.hinges()) {
    const NormalHinges::Frame at = curved_.frame(hinge, positions);
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& corner = curved_.corners()[i];
      forces[corner.particle] += hinge.stiffness * hinge.bend * NormalHinges::gradient(at, corner);
    }
  }
}

void RestCurvature::assembleLinearised(const Positions& positions, const Velocities& velocities,
                                       const StageTimes& times, linear::BlockVector& rhs) const {
  for (const NormalHinges::NormalHinge& hinge : curved_.hinges()) {
    const NormalHinges::Frame at = curved_.frame(
        hinge, [&](int i) -> Vector3d { return positions[i] + times.ahead * velocities[i]; });
    const double impulse = times.a * hinge.stiffness * hinge.bend;
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& corner = curved_.corners()[i];
      rhs.col(corner.particle) += impulse * NormalHinges::gradient(at, corner);
    }
  }
}

void RestCurvature::addJacobian(const Positions& positions, JacobianRows& rows) const {
  for (const NormalHinges::NormalHinge& hinge : curved_.hinges()) {
    const NormalHinges::Frame at = curved_.frame(hinge, positions);
    if (at.area == 0.0) continue;
    for (int i = hinge.begin; i < hinge.end; ++i) {
      const NormalHinges::Corner& row = curved_.corners()[i];
      for (int j = hinge.begin; j < hinge.end; ++j) {
        const NormalHinges::Corner& column = curved_.corners()[j];
        rows.add(row.particle, column.particle,
                 hinge.stiffness * hinge.bend * NormalHinges::hessian(at, row, column));
      }
    }
  }
}

}  // namespace haptex::cloth
