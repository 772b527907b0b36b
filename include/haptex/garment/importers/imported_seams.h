// What importers find out about seams that files do not say.
#pragma once

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// Whether the start of each side meets the end of the other, as it does where panels lie beside
/// each other with their right sides on the same side. Not so if, as the panels are placed, starts
/// lie much nearer to starts and ends to ends: by less than half the sum of squared distances. A
/// short edge far from the one it is sewn to decides nothing.
/// @param seam of panels that are placed by a position
bool oppositeEndsMeet(const Pattern& pattern, const Seam& seam);

/// An easing with which the seam is sound: the usual one or, rounded up to the next thousandth, the
/// difference of its lengths; at most kLargestEasing.
double easingOf(const Pattern& pattern, const Seam& seam);

}  // namespace haptex::garment
