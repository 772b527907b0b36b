// A sheet of 0.5 m square, folded in half so that its layers lie on one another.
#pragma once

#include <cmath>
#include <stdexcept>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::bench {

/// Flat sheet around a half circle as wide as the fabric is thick, in the plane of x and z.
inline mesh::ClothMesh foldedSheet(int cells, double thickness) {
  constexpr double kSide = 0.5;  // m
  mesh::ClothMesh mesh =
      mesh::makeRectangle(kSide, kSide, cells, cells, mesh::Triangulation::kAlternating);
  const double radius = 0.5 * thickness, arc = M_PI * radius;
  const double straight = 0.5 * (kSide - arc);  // of each layer
  for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
    const double along = mesh.rest_coordinates[i].y();
    Eigen::Vector3d& position = mesh.initial_positions[i];
    if (along < straight) {
      position = {-along, position.y(), 0.0};
    } else if (along > straight + arc) {
      position = {-(kSide - along), position.y(), thickness};
    } else {
      const double angle = (along - straight) / radius;
      position = {-straight - radius * std::sin(angle), position.y(),
                  radius * (1.0 - std::cos(angle))};
    }
  }
  return mesh;
}

/// Its lower layer is held along three edges, the upper one lies on it, and both sag.
class FoldedSheet {
 public:
  /// @param fabric with compression and friction
  FoldedSheet(const material::Fabric& fabric, int cells, const cloth::StepSettings& settings)
      : cloth_(foldedSheet(cells, fabric.compression->thickness), fabric, effects(fabric)),
        state_(cloth_.initialState()),
        integrator_(cloth_, settings) {
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells / 2; ++j) {
        if (i > 0 && i < cells && j > 0) continue;
        hold(j * (cells + 1) + i);
      }
    }
  }

  std::size_t triangleCount() const { return cloth_.mesh().triangles.size(); }
  std::size_t touchingPairs() const {
    return cloth_.selfContact()->touching(state_.positions).size();
  }

  /// @throws std::runtime_error if it was rejected or did not reach its tolerance
  cloth::StepReport step(double time_step) {
    const cloth::StepReport report = integrator_.step(cloth_, state_, time_step);
    if (!report.accepted || !report.linear_converged) {
      throw std::runtime_error("a step did not reach its tolerance");
    }
    return report;
  }

 private:
  static cloth::ModelledEffects effects(const material::Fabric& fabric) {
    cloth::ModelledEffects effects;
    effects.viscosity = !fabric.weft.viscous.isZero();
    effects.gravity = {0.0, 0.0, -9.80665};
    effects.self_collision = true;
    return effects;
  }
  void hold(int particle) {
    cloth::AttachmentPath place;
    place.start = state_.positions[particle];
    cloth_.attach(particle, place);
  }

  cloth::Cloth cloth_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
};

}  // namespace haptex::bench
