#include "haptex/studies/extreme_watch.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/quantity.h"
#include "haptex/proximity/cursor.h"

namespace haptex::studies {
namespace {

/// What kRoundingGrowth refers to (J), but for the energies themselves.
double weightScale(const cloth::Cloth& cloth, const cloth::ClothState& state) {
  double scale = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    scale += cloth.masses()[i] * cloth.effects().gravity.norm() * state.positions[i].norm();
  }
  return scale;
}

bool attachmentsMove(const cloth::Cloth& cloth, const cloth::ClothState& before,
                     const cloth::ClothState& after) {
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i] && before.positions[i] != after.positions[i]) return true;
  }
  return false;
}

}  // namespace

double energyOf(const cloth::Cloth& cloth, const cloth::ClothState& state) {
  double energy = cloth.potentialEnergy(state);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    energy += 0.5 * cloth.masses()[i] * state.velocities[i].squaredNorm();
  }
  return energy;
}

bool isFinite(const cloth::ClothState& state) {
  const auto finite = [](const Eigen::Vector3d& vector) { return vector.allFinite(); };
  return std::isfinite(state.time) &&
         std::all_of(state.positions.begin(), state.positions.end(), finite) &&
         std::all_of(state.velocities.begin(), state.velocities.end(), finite);
}

void EnergyWatch::begin(const cloth::Cloth& cloth, const cloth::ClothState& before) {
  energies_.push_back(energyOf(cloth, before));
  if (energies_.size() > cloth::EnergyBalance::kRemembered + 1) energies_.pop_front();
}

double EnergyWatch::growth(const cloth::Cloth& cloth, const cloth::ClothState& before,
                           const cloth::ClothState& after, double pulling) {
  for (double& energy : energies_) energy += pulling;
  if (cloth.selfContact() != nullptr && attachmentsMove(cloth, before, after)) {
    energies_.clear();
    unwatched_ = cloth::EnergyBalance::kRemembered;
    return 0.0;
  }
  if (unwatched_ > 0) {
    --unwatched_;
    return 0.0;
  }
  const double most = *std::max_element(energies_.begin(), energies_.end());
  const double energy = energyOf(cloth, after);
  const double scale = std::abs(most) + std::abs(energy) + weightScale(cloth, after);
  return base::largerOrNaN(0.0, scale > 0.0 ? (energy - most) / scale : 0.0);
}

IntersectionWatch::IntersectionWatch(const cloth::Cloth& cloth) : cloth_(cloth) {
  if (cloth.selfContact() == nullptr) return;
  intersections_.emplace(cloth.mesh().triangles, mesh::flatPositions(cloth.mesh()));
}

bool IntersectionWatch::failsAt(const cloth::ClothState& state) {
  const auto& places = state.positions;
  if (!intersections_ || !std::all_of(places.begin(), places.end(), proximity::isPlace)) {
    return false;
  }
  is_tangled_ = !intersections_->find(state.positions).empty();
  was_free_ = was_free_ || !(is_tangled_ || touchesItself(state));
  return is_tangled_ && was_free_;
}

bool IntersectionWatch::touchesItself(const cloth::ClothState& state) const {
  const auto& near = cloth_.selfContact()->touching(state.positions);
  return std::any_of(near.begin(), near.end(), [](const cloth::PairEnergy& pair) {
    return pair.distance < cloth::LayerLaw::kTouching;
  });
}

}  // namespace haptex::studies
