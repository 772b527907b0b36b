// Fingertips that do what no hand can.
#pragma once

#include "haptex/studies/extreme_case.h"
#include "haptex/studies/extreme_outcome.h"

namespace haptex::studies {

/// Runs a case of kind kFingertips: both layers in one loop, with fingertips that appear inside of
/// the cloth, leap and pinch, and then are gone. Forces stay within what the contact law gives at
/// the largest depth on the whole sheet.
/// @param most_solved_steps see runExtremeCase()
ExtremeOutcome runTouchedCase(const ExtremeCase& extreme, int most_solved_steps);

}  // namespace haptex::studies
