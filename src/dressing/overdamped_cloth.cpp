#include "haptex/dressing/overdamped_cloth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace haptex::dressing {
namespace {

cloth::StepSettings settingsOf(const OverdampedMotion& motion) {
  cloth::StepSettings settings;
  settings.newton_iterations = 2;
  settings.tolerance = 1e-4;  // what is left over goes into the next step
  settings.threads = motion.threads;
  return settings;
}

}  // namespace

OverdampedCloth::OverdampedCloth(const mesh::ClothMesh& mesh,
                                 const std::vector<material::Fabric>& fabrics,
                                 const cloth::ModelledEffects& effects,
                                 std::vector<mesh::Obstacle> obstacles,
                                 const OverdampedMotion& motion)
    : motion_(motion),
      cloth_(mesh, fabrics, effects),
      collision_(cloth_, std::move(obstacles)),
      state_(cloth_.initialState()),
      integrator_(cloth_, settingsOf(motion)) {}

double OverdampedCloth::step(double time_step) {
  before_ = state_.positions;
  for (Eigen::Vector3d& velocity : state_.velocities) velocity.setZero();
  const double h = std::sqrt(time_step / motion_.damping);
  report_ = collision_.step(cloth_, integrator_, state_, h);
  if (!report_.accepted) throw std::runtime_error("a step of the garment was not finite");
  double farthest = 0.0;
  for (std::size_t i = 0; i < before_.size(); ++i) {
    farthest = std::max(farthest, (state_.positions[i] - before_[i]).norm());
  }
  return farthest;
}

}  // namespace haptex::dressing
