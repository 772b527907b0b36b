// What is watched while the cloth of an extreme case is stepped.
#pragma once

#include <deque>
#include <optional>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/energy_balance.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/proximity/mesh_intersections.h"

namespace haptex::studies {

/// Kinetic energy of the free particles and potential energy (J).
double energyOf(const cloth::Cloth& cloth, const cloth::ClothState& state);
bool isFinite(const cloth::ClothState& state);

/// Steps of a state in a tangle that are not watched. The first one takes the energy of contact out
/// of the pairs in it, which those after it may gain as all that is lost.
constexpr int kUnwatchedTangled = cloth::EnergyBalance::kRemembered + 1;

/// Watches that steps in which nothing does work gain no energy beyond what EnergyBalance allows.
class EnergyWatch {
 public:
  /// @param unwatched steps at first that may gain what was lost while work was done
  explicit EnergyWatch(int unwatched) : unwatched_(unwatched) {}

  /// Before a step: which pairs are in a tangle, and so the energy, may be another thing after it.
  void begin(const cloth::Cloth& cloth, const cloth::ClothState& before);

  /// By how much the energy after the step is above what it may be, over the scale of the energies;
  /// 0 if it is not, or the step is not watched. A step in which attachments move, as those do that
  /// other cloth was in the way of, begins the watch anew: they do work.
  /// @param before  of the last begin()
  /// @param pulling J, what pulling tangles apart has added in the step
  double growth(const cloth::Cloth& cloth, const cloth::ClothState& before,
                const cloth::ClothState& after, double pulling = 0.0);

 private:
  int unwatched_;
  std::deque<double> energies_;  // J, before the last steps
};

/// Watches that cloth which collides with itself does not intersect itself any more once it neither
/// did nor touched itself (LayerLaw::kTouching); nothing of other cloth.
class IntersectionWatch {
 public:
  /// @param cloth must outlive this
  explicit IntersectionWatch(const cloth::Cloth& cloth);

  /// Whether the state intersects itself and an earlier one was free.
  bool failsAt(const cloth::ClothState& state);
  /// Whether the last state was in a tangle.
  bool isTangled() const { return is_tangled_; }

 private:
  bool touchesItself(const cloth::ClothState& state) const;

  const cloth::Cloth& cloth_;
  std::optional<proximity::MeshIntersections> intersections_;
  bool was_free_ = false;
  bool is_tangled_ = false;
};

}  // namespace haptex::studies
