// Runs extreme cases.
#pragma once

#include "haptex/studies/extreme_case.h"
#include "haptex/studies/extreme_outcome.h"

namespace haptex::studies {

constexpr int kMostSolvedSteps = 20000;  // in which cloth is expected to return

/// Runs a case: the cloth at rest, the disturbance, free steps with the energy watched, then larger
/// steps until it is at rest. An explicit method is held to finite numbers only, whatever number of
/// its steps is rejected.
///
/// A hanging sheet has more than one rest state: strains do not tell a triangle from its mirror
/// image, so folds cost nothing, and in a sheet that resists stretch and shear but not bending
/// folds may lock each other as in crumpled paper. A disturbance that turns elements over may leave
/// it there; it counts as at rest if its forces are balanced. In a taut sheet only needles stay
/// turned over: it counts as at rest elsewhere if it also comes back there after a push.
/// @param most_solved_steps of the last ones, where those with the case's own solves did not
/// suffice
ExtremeOutcome runExtremeCase(const ExtremeCase& extreme, int most_solved_steps = kMostSolvedSteps);

}  // namespace haptex::studies
