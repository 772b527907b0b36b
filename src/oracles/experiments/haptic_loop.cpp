#include "haptex/oracles/experiments/haptic_loop.h"

#include <cmath>

namespace haptex::oracles {
namespace {

using contact::Fingertip;
using contact::Fingertips;

std::vector<Eigen::Vector3d> restPositions(const mesh::ClothMesh& mesh) {
  std::vector<Eigen::Vector3d> positions;
  for (const Eigen::Vector2d& rest : mesh.rest_coordinates) {
    positions.emplace_back(rest.x(), rest.y(), 0.0);
  }
  return positions;
}

cloth::ModelledEffects withPointLoads(cloth::ModelledEffects effects) {
  effects.point_loads = true;
  return effects;
}

}  // namespace

HapticLoop::HapticLoop(HapticLoopSettings settings)
    : settings_(std::move(settings)),
      cloth_(settings_.mesh, settings_.fabric, withPointLoads(settings_.effects)),
      state_(cloth_.initialState()),
      integrator_(cloth_, settings_.step),
      hierarchy_(settings_.mesh.triangles, restPositions(settings_.mesh)),
      layer_(settings_.mesh, settings_.fabric, settings_.effects, settings_.haptics),
      supply_(settings_.haptics, settings_.mesh.triangles.size()),
      ticks_per_step_(
          static_cast<int>(std::lround(settings_.large_scale_step / settings_.haptics.time_step))) {
  std::vector<char> attached(settings_.mesh.rest_coordinates.size(), 0);
  for (int particle : settings_.attached_particles) {
    cloth::AttachmentPath path;
    path.start = state_.positions[particle];
    cloth_.attach(particle, path);
    attached[particle] = 1;
  }
  supply_.setAttached(attached);
  layer_.receive(state_.positions, state_.velocities, settings_.large_scale_step);
}

void HapticLoop::step(const Fingertips& fingertips) {
  if (ticks_ % ticks_per_step_ == 0) {
    stepCloth();
    if (settings_.haptics.layer == contact::HapticSettings::Layer::kPatch) choosePatch(fingertips);
  }
  ++ticks_;
  layer_.step(fingertips);
  if (!layer_.lastStepAccepted()) ++rejected_steps_;
}

void HapticLoop::rest(const Fingertips& fingertips, double seconds) {
  const double end = time() + seconds - 0.5 * settings_.haptics.time_step;
  while (time() < end) step(fingertips);
}

void HapticLoop::stepCloth() {
  cloth_.setPointLoads(layer_.loads());
  if (!integrator_.step(cloth_, state_, settings_.large_scale_step).accepted) ++rejected_steps_;
  layer_.receive(state_.positions, state_.velocities, settings_.large_scale_step);
}

void HapticLoop::choosePatch(const Fingertips& fingertips) {
  hierarchy_.refit(state_.positions);
  supply_.ask(fingertips, settings_.large_scale_step,
              [&](const contact::SearchVolume& volume, contact::PatchSelection& selection) {
                hierarchy_.query(
                    proximity::Cursor::capsule(volume.begin, volume.end, volume.radius),
                    {volume.distance, volume.count}, near_);
                for (std::size_t rank = 0; rank < near_.size(); ++rank) {
                  selection.add(near_[rank].triangle, near_[rank].distance, static_cast<int>(rank),
                                settings_.haptics);
                }
                return true;
              });
  if (!supply_.isOutdated()) return;
  ++patch_changes_;
  layer_.exchange(supply_.prepare(layer_));
}

Eigen::Vector3d HapticLoop::attachmentForce() const {
  std::vector<Eigen::Vector3d> forces;
  cloth_.computeForces(state_, forces);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (cloth_.isAttached(static_cast<int>(i))) sum -= forces[i];
  }
  return sum;
}

}  // namespace haptex::oracles
