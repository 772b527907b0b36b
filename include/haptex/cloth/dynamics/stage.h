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
  StrainPast past;  ///< with the same a: what strain rates of Newton iterations are taken from, or
                    ///< of count 0, if from v, which is right to the second order
};

/// Where the first linear solve of a stage linearises: (xg, vg), which reaches the stage in `ahead`
/// seconds,
///   x* + a vg = xg + ahead vg.
struct StageGuess {
  const Positions& positions;    ///< xg
  const Velocities& velocities;  ///< vg
  double ahead;                  ///< s, >= 0
  /// Near the end of the stage (m): where Newton iterations that end by StepSettings::newton_error
  /// start, unless something touches, without the first solve. Null: nothing is known.
  const Positions* predicted = nullptr;
};

}  // namespace haptex::cloth
