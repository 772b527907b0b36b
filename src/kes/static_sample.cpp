#include "haptex/kes/static_sample.h"

namespace haptex::kes {
namespace {

using Eigen::Vector3d;

cloth::ModelledEffects withViscosity(cloth::ModelledEffects effects, bool viscosity) {
  effects.viscosity = viscosity;
  return effects;
}

}  // namespace

StaticSample::StaticSample(mesh::ClothMesh mesh, const material::Fabric& fabric,
                           const cloth::ModelledEffects& effects)
    : cloth_(mesh, fabric, withViscosity(effects, false)),
      moving_(std::move(mesh), fabric, withViscosity(effects, true)),
      state_(cloth_.initialState()),
      equilibrium_(cloth_) {}

void StaticSample::equilibrate(const std::vector<int>& held, const Field& place,
                               const Vector3d& disturbance) {
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
    state_.positions[i] = place(mesh().rest_coordinates[i]);
    for (int axis = 0; axis < 3; ++axis) {
      if (disturbance[axis] > 0.0) state_.positions[i][axis] += disturbance[axis] * normal(random_);
    }
  }
  cloth_.releaseAll();
  for (int particle : held) {
    cloth::AttachmentPath path;
    path.start = place(mesh().rest_coordinates[particle]);
    cloth_.attach(particle, path);
  }
  equilibrium_.settle(cloth_, state_, 1.0);
  forces_ = equilibrium_.forces();
}

void StaticSample::moveAs(const Field& velocity) {
  for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
    state_.velocities[i] = velocity(mesh().rest_coordinates[i]);
  }
  moving_.computeForces(state_, forces_);
}

}  // namespace haptex::kes
