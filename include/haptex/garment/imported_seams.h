// What importers find out about seams that files do not say.
#pragma once

#include "haptex/garment/pattern.h"

namespace haptex::garment {

/// Whether the start of one side lies nearer to the end of the other than starts to starts and
/// ends to ends, as the panels are placed: by the sum of squared distances. True where both are
/// equal to 1e-9 of themselves.
/// @param seam of panels that are placed by a position
bool oppositeEndsMeet(const Pattern& pattern, const Seam& seam);

/// An easing with which the seam is sound: the usual one or, rounded up to the next thousandth, the
/// difference of its lengths; at most kLargestEasing.
double easingOf(const Pattern& pattern, const Seam& seam);

}  // namespace haptex::garment
