// Refinement of triangulations to nearly equal edges and angles that are not small.
#pragma once

#include "haptex/garment/triangulation/delaunay.h"

namespace haptex::garment {

/// rad, 25 degrees: triangles with smaller angles are refined.
constexpr double kLeastAngle = 0.4363323129985824;
/// rad, 60 degrees: corners of outlines that are sharper keep smaller angles near them.
constexpr double kSharpCorner = 1.0471975511965976;

/// What is inside of the outlines.
enum class Filling {
  kEven,   ///< points are added everywhere
  kGiven,  ///< the points that are there
};

/// Adds points to a triangulation whose outlines have edges of about `edge_length`, until its other
/// edges are of about that length, too, and no angle is smaller than kLeastAngle. Points are added
/// in the centres of the circles of the largest triangles, then of those with small angles (Chew,
/// Guaranteed-quality mesh generation for curved surfaces, 1993); a side of an outline is halved
/// where it lies before such a centre. Afterwards they move to the middle of those around them
/// where this makes no angle smaller that is small. All triangles are Delaunay, the same input
/// always gives the same triangles.
///
/// Not refined are triangles whose shortest edge leads from one side of a corner sharper than
/// kSharpCorner to its other side, no farther than 4 edge lengths from it: they are as narrow as
/// the outline. Where halving would give sides below 1/32 of the edge length angles may stay small,
/// too.
///
/// @param edge_length m, finite and > 0
/// @param filling kGiven: only triangles with small angles are refined, and no point moves
/// @return for every point that was added to an outline, in order, between which two points
std::vector<std::array<int, 3>> refine(Delaunay& triangulation, double edge_length,
                                       Filling filling = Filling::kEven);

}  // namespace haptex::garment
