// Cloth among obstacles whose motion is overdamped.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::dressing {

struct OverdampedMotion {
  double damping;  ///< 1/s, > 0: every particle moves at F / (m damping)
  int threads;     ///< of a step
};

/// Steps of backward Euler that start without velocity end at the minimum of
///   |x - x0|_M^2 / (2 h^2) + potential energy:
/// of the overdamped motion m damping x' = F that is the implicit step of the length damping h^2.
class OverdampedCloth {
 public:
  /// @throws std::invalid_argument what cloth::Cloth, cloth::Integrator and
  ///   contact::ObstacleCollision say
  OverdampedCloth(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                  const cloth::ModelledEffects& effects, std::vector<mesh::Obstacle> obstacles,
                  const OverdampedMotion& motion);
  OverdampedCloth(const OverdampedCloth&) = delete;  // its parts refer to each other
  OverdampedCloth& operator=(const OverdampedCloth&) = delete;

  cloth::Cloth& cloth() { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  const cloth::StepReport& report() const { return report_; }  ///< of the last step

  /// @param time_step s, > 0
  /// @return m, the farthest way of a particle
  /// @throws std::runtime_error if the step is not finite
  double step(double time_step);

 private:
  OverdampedMotion motion_;
  cloth::Cloth cloth_;
  contact::ObstacleCollision collision_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
  cloth::StepReport report_;
  std::vector<Eigen::Vector3d> before_;  // m
};

}  // namespace haptex::dressing
