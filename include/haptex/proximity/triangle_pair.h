// Distances between two triangles.
#pragma once

#include "haptex/proximity/triangle_distance.h"

namespace haptex::proximity {

/// The point of a triangle closest to another triangle, 0 away (to rounding) where they touch or
/// intersect; it is then a point of both. Either may be degenerate: a segment or a point.
///
/// The best of all pairs of features that can hold the answer: corner and edge, edge and edge,
/// corner and face, edge through face. Each is the distance of two points that were computed, so a
/// wrong decision between features can only miss a better pair, and next to a decision the pairs of
/// both sides are equally good. Projections are orthogonalised instead of solved through
/// determinants, so that thin triangles and nearly parallel edges lose no digits: the distance is
/// right to some 1e-16 times the largest coordinate difference.
TrianglePoint closestPoint(const Triangle& triangle, const Triangle& other);

}  // namespace haptex::proximity
