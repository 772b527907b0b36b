// What changes a SimulatedCloth between two steps.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/proximity/cursor.h"
#include "haptex/scene/frame_name.h"
#include "haptex/simulation/particle_requests.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

using base::refuse;

namespace {

/// What SimulatedCloth::excluded() says of a particle.
enum Excluded : char { kIncluded, kWasFree, kWasAttached };

}  // namespace

void SimulatedCloth::setFabric(material::Fabric fabric) {
  std::vector<material::Fabric> fabrics = cloth_.fabrics();
  fabrics.front() = std::move(fabric);
  setMaterial(std::move(fabrics), cloth_.effects().gravity, cloth_.effects().air);
}

void SimulatedCloth::setMaterial(std::vector<material::Fabric> fabrics,
                                 const Eigen::Vector3d& gravity,
                                 const std::optional<cloth::Air>& air) {
  for (const material::Fabric& fabric : fabrics) {
    if (collision_) collision_->requireFriction(fabric);
  }
  cloth_.setMaterial(std::move(fabrics), gravity, air);
  cloth_.forget(state_);
  if (part_) {
    compute(std::move(excluded_));
  } else if (!cloth_.forces().pairs().empty()) {
    makeIntegrators();
  }
  wake();
}

void SimulatedCloth::setPointLoads(const std::vector<cloth::PointLoad>& loads) {
  const bool changes = !loads.empty() || loaded_;
  cloth_.setPointLoads(loads);
  if (part_) part_->setPointLoads(loads);
  loaded_ = !loads.empty();
  if (changes) wake();
}

void SimulatedCloth::setExternalForce(std::uint32_t particle, const Eigen::Vector3d& force) {
  cloth_.setExternalForce(static_cast<int>(particle), force);
  if (part_) part_->setExternalForce(static_cast<int>(particle), force);
  pushed_ = true;
  wake();
}

void SimulatedCloth::setState(const std::vector<std::uint32_t>& particles,
                              const std::vector<Eigen::Vector3d>& positions,
                              const std::vector<Eigen::Vector3d>& velocities) {
  if (positions.empty() && velocities.empty()) {
    refuse("positions and velocities are empty: allowed is one of them, or both");
  }
  requireParticles(particles, cloth_.particleCount());
  std::vector<int> indices(particles.begin(), particles.end());
  if (particles.empty()) {
    indices.resize(cloth_.particleCount());
    std::iota(indices.begin(), indices.end(), 0);
  }
  if (!positions.empty()) {
    requireOneEach("positions", positions.size(), indices.size(), "none: they stay");
  }
  if (!velocities.empty()) {
    requireOneEach("velocities", velocities.size(), indices.size(), "none: they stay");
  }
  requireAllWithin("positions", positions, proximity::kMaxLength, "m");
  requireAllWithin("velocities", velocities, proximity::kMaxLength, "m/s");
  for (std::size_t i = 0; i < indices.size(); ++i) {
    requireHeld(indices[i], positions.empty() ? nullptr : &positions[i],
                velocities.empty() ? nullptr : &velocities[i]);
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (cloth_.attachments()[indices[i]]) continue;
    if (!positions.empty()) state_.positions[indices[i]] = positions[i];
    if (!velocities.empty()) state_.velocities[indices[i]] = velocities[i];
  }
  cloth_.ties().place(state_.time, state_.positions);
  cloth_.ties().carry(state_.time, state_.velocities);
  if (!positions.empty()) cloth_.forget(state_);
  makeIntegrators();  // the old ones remember where they have been
  wake();
}

/// @param position, velocity that a particle shall get, or null
void SimulatedCloth::requireHeld(int particle, const Eigen::Vector3d* position,
                                 const Eigen::Vector3d* velocity) const {
  const std::optional<cloth::AttachmentPath>& path = cloth_.attachments()[particle];
  if (!path) return;
  const char* first = excluded_.empty() || excluded_[particle] == kIncluded ? "release" : "include";
  const auto require = [&](const char* what, const Eigen::Vector3d& wanted,
                           const Eigen::Vector3d& held, const char* unit) {
    if ((wanted - held).norm() <= scene::kHeldTolerance) return;
    refuse("particle ", particle, " is attached: allowed is its ", what, " (", held.x(), ", ",
           held.y(), ", ", held.z(), ") ", unit, ", not (", wanted.x(), ", ", wanted.y(), ", ",
           wanted.z(), "), or ", first, " it first");
  };
  if (position != nullptr) require("place", *position, path->position(state_.time), "m");
  if (velocity != nullptr) require("velocity", *velocity, state_.velocities[particle], "m/s");
}

void SimulatedCloth::attach(const std::vector<std::uint32_t>& particles) {
  const std::vector<int> indices = requireSome(particles);
  requireIncluded(indices);
  for (const int particle : indices) cloth_.requireAttachable(particle);
  for (const int particle : indices) {
    frames_.drop(particle);
    cloth_.attach(particle, {state_.positions[particle], Eigen::Vector3d::Zero(), state_.time, 0});
  }
  wake();
}

void SimulatedCloth::attach(const std::vector<std::uint32_t>& particles, const std::string& frame,
                            const Eigen::Isometry3d& pose) {
  if (!scene::isFrameName(frame)) {
    refuse("frame = ", base::quoted(frame), ": allowed is ", scene::kFrameNames);
  }
  requireFramePose(frame, pose);
  attach(particles);
  frames_.carry(frame, pose, {particles.begin(), particles.end()}, state_);
}

void SimulatedCloth::moveFrame(std::size_t frame, const Eigen::Isometry3d& pose) {
  requireFramePose(frames_.name(frame), pose);
  frames_.move(frame, pose);
}

void SimulatedCloth::attach(const std::vector<std::uint32_t>& particles,
                            const std::vector<Eigen::Vector3d>& places) {
  const std::vector<int> indices = requireSome(particles);
  requireIncluded(indices);
  requireOneEach("positions", places.size(), indices.size(), "none to attach them where they are");
  requireAllWithin("positions", places, kMaxCoordinate, "m");
  for (const int particle : indices) cloth_.requireAttachable(particle);
  for (std::size_t i = 0; i < places.size(); ++i) {
    frames_.drop(indices[i]);
    cloth_.attach(indices[i], {places[i], Eigen::Vector3d::Zero(), state_.time, 0});
  }
  wake();
}

void SimulatedCloth::move(const std::vector<std::uint32_t>& particles,
                          const Eigen::Vector3d& displacement, double duration) {
  const std::vector<int> indices = requireAttached(particles);
  if (!displacement.allFinite()) {
    refuse("displacement = (", displacement.x(), ", ", displacement.y(), ", ", displacement.z(),
           ") m: allowed are finite numbers");
  }
  if (!std::isfinite(duration) || duration < 0) {
    refuse("duration = ", duration, " s: allowed are finite numbers >= 0");
  }
  std::vector<Eigen::Vector3d> starts;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    starts.push_back(cloth_.attachments()[indices[i]]->position(state_.time));
    requireWithin("the end of the path of " + element("particles", i), starts[i] + displacement,
                  kMaxCoordinate, "m");
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    frames_.drop(indices[i]);
    cloth_.attach(indices[i], {starts[i], displacement, state_.time, duration});
  }
  wake();
}

void SimulatedCloth::release(const std::vector<std::uint32_t>& particles) {
  for (const int particle : requireAttached(particles)) {
    frames_.drop(particle);
    cloth_.release(particle);
  }
  wake();
}

void SimulatedCloth::exclude(const std::vector<std::uint32_t>& particles) {
  const std::vector<int> indices = requireSome(particles);
  std::vector<char> excluded = excluded_;
  excluded.resize(cloth_.particleCount(), kIncluded);
  for (const int particle : indices) {
    if (excluded[particle] != kIncluded) continue;
    excluded[particle] = cloth_.isAttached(particle) ? kWasAttached : kWasFree;
  }
  if (std::find(excluded.begin(), excluded.end(), kIncluded) == excluded.end()) {
    refuse("all ", excluded.size(),
           " particles would be excluded: allowed are all but one; to stop all, pause");
  }
  compute(std::move(excluded));
  for (const int particle : indices) {
    state_.velocities[particle].setZero();
    cloth_.attach(particle, {state_.positions[particle], Eigen::Vector3d::Zero(), state_.time, 0});
  }
  wake();
}

void SimulatedCloth::include(const std::vector<std::uint32_t>& particles) {
  requireParticles(particles, cloth_.particleCount());
  if (excluded_.empty()) return;
  std::vector<std::uint32_t> indices = particles;
  if (particles.empty()) {
    indices.resize(cloth_.particleCount());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  std::vector<char> excluded = excluded_;
  for (const std::uint32_t particle : indices) excluded[particle] = kIncluded;
  const std::vector<char> before = excluded_;
  compute(std::move(excluded));
  for (const std::uint32_t particle : indices) {
    if (before[particle] == kWasFree) cloth_.release(static_cast<int>(particle));
  }
  wake();
}

/// @param excluded per particle
void SimulatedCloth::compute(std::vector<char> excluded) {
  std::vector<char> included(excluded.size());
  std::transform(excluded.begin(), excluded.end(), included.begin(),
                 [](char state) { return state == kIncluded; });
  if (std::find(included.begin(), included.end(), 0) == included.end()) {
    excluded.clear();
    part_.reset();
  } else {
    part_ = cloth::ClothPart(cloth_, included);
  }
  excluded_ = std::move(excluded);
  makeIntegrators();
}

void SimulatedCloth::requireIncluded(const std::vector<int>& particles) const {
  for (std::size_t i = 0; !excluded_.empty() && i < particles.size(); ++i) {
    if (excluded_[particles[i]] == kIncluded) continue;
    refuse(element("particles", i), " = ", particles[i],
           " is excluded from the computation: allowed are included particles; include it first");
  }
}

std::vector<cloth::JacobianBlock> SimulatedCloth::jacobian(
    const std::vector<std::uint32_t>& particles) const {
  return cloth_.jacobian(state_, requireSome(particles));
}

std::vector<int> SimulatedCloth::requireSome(const std::vector<std::uint32_t>& particles) const {
  if (particles.empty()) refuse("particles is empty: allowed is at least one particle");
  requireParticles(particles, cloth_.particleCount());
  return {particles.begin(), particles.end()};
}

std::vector<int> SimulatedCloth::requireAttached(
    const std::vector<std::uint32_t>& particles) const {
  const std::vector<int> indices = requireSome(particles);
  requireIncluded(indices);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!cloth_.isAttached(indices[i])) {
      refuse(element("particles", i), " = ", indices[i],
             " is not attached: allowed are attached particles");
    }
  }
  return indices;
}

}  // namespace haptex::simulation
