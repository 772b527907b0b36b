#include "haptex/cloth/dynamics/energy_balance.h"

#include <algorithm>
#include <cmath>

namespace haptex::cloth {

using Eigen::Vector3d;

namespace {

double freeKineticEnergy(const Cloth& cloth, const Velocities& velocities) {
  double twice = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) twice += cloth.masses()[i] * velocities[i].squaredNorm();
  }
  return 0.5 * twice;
}

/// Of the attachments' forces over their ways (J).
double workOf(const Cloth& cloth, const std::vector<Vector3d>& forces, const Positions& begin,
              const Positions& end) {
  double work = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) work -= forces[i].dot(end[i] - begin[i]);
  }
  return work;
}

/// Of the contacts' forces (J) over the ways of the bodies, and out of what they had penetrated;
/// those of bodies with mass, which have no more energy for that, over their ways alone.
double contactWork(const Cloth& cloth, const std::vector<ContactReaction>& reactions,
                   const Positions& begin, double h) {
  double work = 0.0;
  for (std::size_t c = 0; c < reactions.size(); ++c) {
    const ParticleContact& contact = cloth.contacts()[c];
    if (contact.body >= 0) {
      work += h * reactions[c].force.dot(reactions[c].velocity);
      continue;
    }
    const Vector3d way = h * contact.velocity;
    const double depth =
        -contact.gap - contact.normal.dot(begin[contact.particle] - (contact.place - way));
    work += reactions[c].force.dot(way + std::max(0.0, depth) * contact.normal);
  }
  return work;
}

}  // namespace

EnergyBalance::EnergyBalance(const Cloth& cloth, bool rates_from_strains, linear::ThreadPool* pool)
    : pool_(pool),
      rates_from_strains_(rates_from_strains),
      last_positions_(cloth.initialState().positions),
      forces_(cloth.particleCount()),
      jumped_(cloth.initialState()) {}

void EnergyBalance::begin(const Cloth& cloth, const ClothState& begin) {
  const bool goes_on = begin.positions == last_positions_;
  if (!goes_on) forget();
  const bool known = goes_on && revision_ == cloth.revision() && cloth.forces().memorySize() == 0;
  potential_begin_ = known ? potential_kept_ : cloth.potentialEnergy(begin, pool_);
  kinetic_begin_ = freeKineticEnergy(cloth, begin.velocities);
}

double EnergyBalance::excess(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                             const std::vector<ContactReaction>& reactions) {
  growth_ = growth(cloth, begin, end, reactions);
  return growth_ - reserve();
}

void EnergyBalance::forget() {
  remembered_ = 0;
  next_ = 0;
}

/// The most that a row of steps up to the last one has lost (J).
double EnergyBalance::reserve() const {
  double most = 0.0;
  for (int i = 0; i < remembered_; ++i) most = std::max(most, lost_[i]);
  return most;
}

double EnergyBalance::growth(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                             const std::vector<ContactReaction>& reactions) {
  constexpr double kRounding = 1e-12;
  potential_end_ = cloth.potentialEnergy(end, pool_);
  kinetic_end_ = freeKineticEnergy(cloth, end.velocities);
  double growth = potential_end_ - potential_begin_ + (kinetic_end_ - kinetic_begin_);
  growth -= kRounding *
            (std::abs(potential_end_) + std::abs(potential_begin_) + kinetic_begin_ + kinetic_end_);
  if (growth <= 0.0) return growth;
  growth -= std::max(0.0, attachmentWork(cloth, begin, end));
  const double h = end.time - begin.time;
  growth -= std::max(0.0, contactWork(cloth, reactions, begin.positions, h));
  if (cloth.seamGap(begin.time) > 0.0) growth -= closingWork(cloth, begin, end);
  if (const SelfContact* self = cloth.selfContact()) {
    growth -= std::max(0.0, self->obstacleWork(end.ofForces(pool_)));
  }
  if (cloth.forces().isDriven() && !(growth <= 0.0)) {
    const double at_end = std::max(0.0, h * drivenPower(cloth, end));
    growth -= growth <= at_end ? growth : std::max(at_end, h * drivenPower(cloth, begin));
  }
  return growth <= 0.0 ? 0.0 : growth;  // work that is left over is not for later steps
}

void EnergyBalance::keep(const Cloth& cloth, const ClothState& end, double taken) {
  const double lost = taken - growth_;
  if (!std::isfinite(lost)) return forget();
  for (double& since : lost_) since += lost;
  lost_[next_] = lost;
  next_ = (next_ + 1) % kRemembered;
  remembered_ = std::min(remembered_ + 1, kRemembered);
  last_positions_ = end.positions;
  potential_kept_ = potential_end_;
  revision_ = cloth.revision();
}

double EnergyBalance::attachmentWork(const Cloth& cloth, const ClothState& begin,
                                     const ClothState& end) {
  jumped_.positions = begin.positions;
  jumped_.memory = begin.memory;
  bool moved = false;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) continue;
    moved = moved || end.positions[i] != begin.positions[i];
    jumped_.positions[i] = end.positions[i];
  }
  cloth.ties().place(begin.time, jumped_.positions);
  if (!moved) return 0.0;
  const double h = end.time - begin.time;
  computeForces(cloth, end, StrainPast::since(begin.positions, h));
  const double at_end = workOf(cloth, forces_, begin.positions, end.positions);
  StrainPast ahead{h};  // with the same rates, (e(end) - e(begin)) / h
  ahead.add(begin.positions, 2.0);
  ahead.add(end.positions, -1.0);
  computeForces(cloth, begin, ahead);
  const double at_begin = workOf(cloth, forces_, begin.positions, end.positions);
  const double of_jump = cloth.potentialEnergy(jumped_, pool_) - potential_begin_;
  return std::min(std::max(at_end, 0.5 * (at_begin + at_end)),
                  2.0 * std::max(0.0, of_jump) + kinetic_begin_);
}

/// Of what closes seams (J), of the forces at the beginning or the end of the step, whichever is
/// more; at least 0.
double EnergyBalance::closingWork(const Cloth& cloth, const ClothState& begin,
                                  const ClothState& end) {
  const Ties& ties = cloth.ties();
  double most = 0.0;
  for (const ClothState* at : {&begin, &end}) {
    std::fill(forces_.begin(), forces_.end(), Vector3d::Zero());
    cloth.forces().addUntiedForces(at->ofForces(), forces_);
    double work = 0.0;
    for (std::size_t t = 0; t < ties.resolved().size(); ++t) {
      const Vector3d way = ties.gap(t, end.time) - ties.gap(t, begin.time);
      work -= forces_[ties.resolved()[t].particle].dot(way);
    }
    most = std::max(most, work);
  }
  return most;
}

/// Into forces_. @param past what rates are taken from, if they are not the velocities'
void EnergyBalance::computeForces(const Cloth& cloth, const ClothState& at,
                                  const StrainPast& past) {
  ForceState state = at.ofForces();
  if (rates_from_strains_) state.past = &past;
  std::fill(forces_.begin(), forces_.end(), Vector3d::Zero());
  cloth.forces().addForces(state, forces_);
}

/// Of driven forces (W), those of the air. Those on attached particles count here, because the
/// attachments' work is that of all forces on them.
double EnergyBalance::drivenPower(const Cloth& cloth, const ClothState& state) {
  std::fill(forces_.begin(), forces_.end(), Vector3d::Zero());
  cloth.forces().addDrivenForces(state.ofForces(), forces_);
  double power = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    power += forces_[i].dot(state.velocities[i]);
  }
  return power;
}

}  // namespace haptex::cloth
