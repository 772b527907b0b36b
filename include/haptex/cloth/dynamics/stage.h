// What a stage of an implicit step is to find, and where its first solve starts.
#pragma once

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// Find (x, v) with
///   M (v - v*) = a F(x, v),  x = x* + a v.
struct Stage {
  const ClothState& base;  ///< x*, v*, the time from which share counts, and what forces remember
                           ///< from the step's beginning
  double a;                ///< s, finite and > 0
  double end;              ///< s, simulated, of the places of the attached particles
  double share;            ///< of the way from x* to their place that they go in the stage, and of
                           ///< the time from base's to end at which its forces act
  /// Strain rates of Newton iterations.
  enum class Rates {
    kSinceBase,     ///< (e - e*) / a, which vanishes under every rigid motion from x*
    kOfVelocities,  ///< of v, to the second order
  } rates;
};

/// Where the first linear solve of a stage linearises: (xg, vg), which reaches the stage in `ahead`
/// seconds,
///   x* + a vg = xg + ahead vg.
struct StageGuess {
  const Positions& positions;    ///< xg
  const Velocities& velocities;  ///< vg
  double ahead;                  ///< s, >= 0
};

}  // namespace haptex::cloth
