// The cloth of an extreme case, at rest, disturbed and at rest again.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/studies/extreme_case.h"
#include "haptex/studies/extreme_outcome.h"
#include "haptex/studies/extreme_watch.h"

namespace haptex::studies {

/// Particles of the sheet of a case that are attached: its top edge, or all sides.
std::vector<int> attachedParticles(const ExtremeCase& extreme, const mesh::ClothMesh& mesh);

/// A cloth that is held where it is as the case says.
cloth::Cloth clothOf(const ExtremeCase& extreme, const mesh::ClothMesh& mesh,
                     const std::optional<cloth::Air>& air);

/// The same without collision with itself. Flat cloth has the same rest, but soft cloth, which
/// gravity stretches by metres, gets there in fewer steps.
cloth::Cloth apart(const ExtremeCase& extreme, const mesh::ClothMesh& mesh,
                   const std::optional<cloth::Air>& air);

/// The cloth's rest state, from its initial positions.
/// @throws std::runtime_error if it does not come to rest
cloth::ClothState restOf(const cloth::Cloth& cloth);

/// Largest distance of a particle of the state from that of the other, over the largest extent of
/// the other.
double distanceBetween(const cloth::ClothState& state, const cloth::ClothState& other);

/// How a cloth has come to rest, or not.
struct Settling {
  double error = 0.0;       ///< distanceBetween() state and rest at the end
  double growth = 0.0;      ///< largest of EnergyWatch
  bool intersects = false;  ///< IntersectionWatch has failed
  int steps = 0;
  int rejected = 0;
  bool slow = false;  ///< the case's own solves did not suffice
  /// Largest force on a free particle at the end, over the largest on an attached one.
  double unbalanced = 0.0;
};

/// Lets the state come to rest by backward Euler, in steps that grow up to a sixth of the cloth's
/// slowest period: with the solves per step of the case, and if that is too slow with as many as a
/// step needs. What a linearised step stretches while it turns resists the turning, so stiff light
/// cloth creeps. Cloth that collides with itself is let go for as long as its own solves may need:
/// friction and layers on layers let it rest in many ways, and how is not judged.
/// @param most_solved_steps with as many solves as a step needs
Settling settle(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                const cloth::ClothState& rest, int most_solved_steps,
                IntersectionWatch& intersections, cloth::ClothState& state);

/// Lets it settle and tells what came out.
void settleAndJudge(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                    const cloth::ClothState& rest, int most_solved_steps,
                    IntersectionWatch& intersections, cloth::ClothState& state,
                    ExtremeOutcome& outcome);

}  // namespace haptex::studies
