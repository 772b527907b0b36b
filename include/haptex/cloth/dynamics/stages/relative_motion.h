// A limit on how far neighbouring particles may move relative to each other in a stage.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/linear/thread_pool.h"

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
class RelativeMotionLimit {
 public:
  /// Allocates here only.
  explicit RelativeMotionLimit(const Cloth& cloth);

  /// @param cloth that of the constructor
  /// @param fixed particles that stay as they are: those that are attached or tied
  /// @param base  m, x* of the stage, where edges have their lengths
  /// @param a     s, of the stage, > 0: positions are x* + a v
  /// @param at    m and m/s; changed
  /// @param pool  shares the search for such edges if it is given
  /// @return whether there was such an edge
  bool apply(const Cloth& cloth, const std::vector<char>& fixed, const Positions& base, double a,
             ClothState& at, linear::ThreadPool* pool = nullptr);

 private:
  std::vector<char> apart_;  // of triangles: whether an edge was beyond the limit at first
  std::vector<char> moved_;  // of particles: the last sweep that gave it an impulse, from 1 on
};

}  // namespace haptex::cloth
