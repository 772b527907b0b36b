#include "haptex/simulation/force_sources.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/simulation/particle_requests.h"

namespace haptex::simulation {
namespace {

using base::refuse;
using Eigen::Vector3d;

void requireSound(const std::string& source, const ParticleForces& request, std::size_t count) {
  if (source.empty()) refuse("source is empty: allowed is a text that tells whose they are");
  requireOneEach("forces", request.forces.size(), request.particles.size());
  requireParticles(request.particles, count);
  requireAllWithin("forces", request.forces, ForceSources::kMaxForce, "N");
  const double lifetime = request.lifetime;
  if (!std::isfinite(lifetime) || lifetime < 0.0 || lifetime > ForceSources::kMaxLifetime) {
    refuse("lifetime = ", lifetime, " s: allowed are finite numbers from 0 to ",
           ForceSources::kMaxLifetime);
  }
}

}  // namespace

void ForceSources::set(const std::string& source, ParticleForces forces) {
  const std::size_t particle_count = particle_count_;
  requireSound(source, forces, particle_count);
  const bool ends = forces.particles.empty() || forces.lifetime == 0.0;
  if (ends) forces = ParticleForces();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (particle_count != particle_count_) refuse("the cloth is being exchanged: ask again");
  Slot* slot = find(source);
  if (slot == nullptr) {
    if (ends) return;
    slot = std::find_if(slots_.begin(), slots_.end(), [](const Slot& it) { return it.isFree(); });
    if (slot == slots_.end()) {
      refuse("source ", base::quoted(source), " is one too many: allowed are ", kMax,
             " whose forces act");
    }
    sums_.resize(particle_count_);  // for the first of all
    slot->source = source;
  }
  std::swap(slot->next, forces);  // the old ones are freed after the lock
  slot->waits = true;
  any_ = true;
}

void ForceSources::apply(SimulatedCloth& simulation) {
  if (!any_) return;
  const double time = simulation.state().time, step = simulation.timeStep();
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool changes = std::any_of(slots_.begin(), slots_.end(),
                                   [&](const Slot& slot) { return slot.changes(time, step); });
  const auto for_each_acting = [this](const auto& visit) {
    for (const Slot& slot : slots_) {
      for (std::size_t i = 0; slot.acts && i < slot.acting.particles.size(); ++i) {
        visit(slot.acting.particles[i], slot.acting.forces[i]);
      }
    }
  };
  if (changes) {
    for_each_acting([&](std::uint32_t particle, const Vector3d& /*force*/) {
      simulation.setExternalForce(particle, Vector3d::Zero());
    });
  }
  for (Slot& slot : slots_) slot.advance(time, step);
  any_ = std::any_of(slots_.begin(), slots_.end(), [](const Slot& it) { return !it.isFree(); });
  if (!changes) return;
  for_each_acting(
      [&](std::uint32_t particle, const Vector3d& /*force*/) { sums_[particle].setZero(); });
  for_each_acting([&](std::uint32_t particle, const Vector3d& force) { sums_[particle] += force; });
  for_each_acting([&](std::uint32_t particle, const Vector3d& /*force*/) {
    simulation.setExternalForce(particle, sums_[particle]);
  });
}

void ForceSources::clear() { clearFor(particle_count_); }

void ForceSources::clearFor(std::size_t particle_count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Slot& slot : slots_) slot.waits = slot.acts = false;
  any_ = false;
  particle_count_ = particle_count;
}

std::size_t ForceSources::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return slots_.size() -
         static_cast<std::size_t>(std::count_if(slots_.begin(), slots_.end(),
                                                [](const Slot& it) { return it.isFree(); }));
}

bool ForceSources::Slot::changes(double time, double step) const {
  if (!waits) return isOver(time, step);
  return !acts || next.particles != acting.particles || next.forces != acting.forces;
}

/// Takes what waits, or ends what is over.
void ForceSources::Slot::advance(double time, double step) {
  if (waits) {
    std::swap(next, acting);
    waits = false;
    acts = !acting.particles.empty();
    end = time + std::max(step, acting.lifetime);
  } else if (isOver(time, step)) {
    acts = false;
  }
}

ForceSources::Slot* ForceSources::find(const std::string& source) {
  for (Slot& slot : slots_) {
    if (!slot.isFree() && slot.source == source) return &slot;
  }
  return nullptr;
}

}  // namespace haptex::simulation
