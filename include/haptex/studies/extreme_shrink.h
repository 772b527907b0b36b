// Makes a failing case small.
#pragma once

#include <functional>

#include "haptex/studies/extreme_case.h"
#include "haptex/studies/extreme_outcome.h"

namespace haptex::studies {

/// The case with fewer cells and steps, without what is modelled, held and disturbed beside the
/// point, and with milder numbers, as far as it still fails: one change after the other is kept if
/// `fails` says so, until none of them is.
/// @param fails of the case given: true; in the same way as that one, if the caller tells ways
/// apart
ExtremeCase shrinkExtremeCase(const ExtremeCase& extreme,
                              const std::function<bool(const ExtremeCase&)>& fails);

/// A case that runExtremeCase() has found to fail, as small as runs make it: a hundred at most,
/// begun as long as those before have taken fewer steps until they were at rest than the slowest
/// case may.
/// @param outcome of the case; the smaller one fails in the same way. If the case does not return,
///   neither does the smaller one, and is still in twice as many steps, unless it had all that the
///   slowest case may take
ExtremeCase shrinkFailure(const ExtremeCase& extreme, const ExtremeOutcome& outcome);

}  // namespace haptex::studies
