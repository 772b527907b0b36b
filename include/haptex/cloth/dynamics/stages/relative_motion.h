// A limit on how far neighbouring particles may move relative to each other in a stage.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// Slows down what a linear solve has sent apart: the ends of every edge that in a stage move
/// relative to each other by more than 0.15 of its length get equal and opposite impulses, so that
/// 0.12 of it is left, edge after edge and again until there is none, ten times at most. Where
/// both ends are free, their momentum stays as it is and their kinetic energy does not grow;
/// angular momentum is not kept. Smooth motion stays as it is as far as it turns or stretches the
/// cloth by less than that in a stage. Ends at the same place of the base get the same velocity.
///
/// A limit on the strain rate (Bridson, Fedkiw and Anderson 2002 allow 0.1 per step) would leave
/// what moves across the edges, which is most of what a solve gets wrong: it takes elements under
/// compression for free to move out of their plane.
///
/// @param fixed particles that stay as they are: those that are attached or tied
/// @param base  m, x* of the stage, where edges have their lengths
/// @param a     s, of the stage, > 0: positions are x* + a v
/// @param at    m and m/s; changed
/// @return whether there was such an edge
bool limitRelativeMotion(const Cloth& cloth, const std::vector<char>& fixed, const Positions& base,
                         double a, ClothState& at);

}  // namespace haptex::cloth
