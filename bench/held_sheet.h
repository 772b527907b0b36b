// The sheet of the HAPTEX performance test of 2005: 0.5 m square, attached horizontally along one
// edge, moving freely under gravity.
#pragma once

#include <stdexcept>
#include <vector>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric.h"

namespace haptex::bench {

constexpr double kFreeMotion = 2.0;  // s, then the sheet starts again

/// The fabric with straight curves. @param stiffness N/m, half of it in shear
inline material::Fabric withStiffness(material::Fabric fabric, double stiffness) {
  using material::StrainStressCurve;
  fabric.weft.elastic = fabric.warp.elastic = StrainStressCurve::linear(stiffness);
  fabric.shear.elastic = StrainStressCurve::linear(0.5 * stiffness);
  return fabric;
}

inline mesh::ClothMesh horizontalSheet(int cells) {
  mesh::ClothMesh mesh =
      mesh::makeRectangle(0.5, 0.5, cells, cells, mesh::Triangulation::kAlternating);
  for (Eigen::Vector3d& position : mesh.initial_positions) {
    position = {position.z(), position.y(), 0.0};
  }
  return mesh;
}

/// Cloth under gravity, of which some particles stay where they are.
class HeldSheet {
 public:
  /// Released where it lies flat, held along one edge.
  HeldSheet(const material::Fabric& fabric, int cells, const cloth::StepSettings& settings)
      : HeldSheet(horizontalSheet(cells), mesh::Side::kTop, fabric, settings) {}

  /// @param held particles of the mesh
  HeldSheet(const mesh::ClothMesh& mesh, const std::vector<int>& held,
            const material::Fabric& fabric, bool self_collision,
            const cloth::StepSettings& settings)
      : cloth_(mesh, fabric, effectsOf(fabric, self_collision)),
        start_(cloth_.initialState()),
        state_(start_),
        integrator_(cloth_, settings) {
    for (int particle : held) {
      cloth::AttachmentPath place;
      place.start = state_.positions[particle];
      cloth_.attach(particle, place);
    }
  }

  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  std::size_t triangleCount() const { return cloth_.mesh().triangles.size(); }

  /// @throws std::runtime_error if it was rejected or did not reach its tolerance
  cloth::StepReport step(double time_step) {
    if (state_.time >= kFreeMotion) state_ = start_;
    const cloth::StepReport report = integrator_.step(cloth_, state_, time_step);
    if (!report.accepted || !report.linear_converged) {
      throw std::runtime_error("a step did not reach its tolerance");
    }
    return report;
  }

 private:
  HeldSheet(const mesh::ClothMesh& mesh, mesh::Side held, const material::Fabric& fabric,
            const cloth::StepSettings& settings)
      : HeldSheet(mesh, sideParticles(mesh, held), fabric, false, settings) {}

  static cloth::ModelledEffects effectsOf(const material::Fabric& fabric, bool self_collision) {
    cloth::ModelledEffects effects;
    effects.viscosity = !fabric.weft.viscous.isZero();
    effects.gravity = {0.0, 0.0, -base::kStandardGravity};
    effects.self_collision = self_collision;
    return effects;
  }

  cloth::Cloth cloth_;
  cloth::ClothState start_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
};

}  // namespace haptex::bench
