// Stages of an implicit step: what each is to find, where its first solve starts, and the stages of
// TR-BDF2 and BDF-2.
#pragma once

#include <cmath>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/recent_motion.h"

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

/// What a stage of TR-BDF2 (Bank et al. 1985) or BDF-2 has beside its x* and v*.
struct StageStart {
  double a = 0.0;        ///< s
  StrainPast past;       ///< of the stage; it refers to the RecentMotion and to the step's begin
  bool goes_on = false;  ///< the motion is known, and leads here
};

/// The seconds of a step of h that are the trapezoidal rule's: then both stages have the same a.
inline double trapezoidPart(double h) { return (2.0 - std::sqrt(2.0)) * h; }

/// The trapezoidal rule over `first` seconds:
///   x* = x + a v,  v* = v + a M^-1 F(x, v),  a = first / 2.
/// @param motion null: not needed @param base gets x* and v*
StageStart startTrapezoid(const Cloth& cloth, const ClothState& begin, double first,
                          const RecentMotion* motion, ClothState& base);

/// BDF-2 from (x0, v0), `before`, over (x1, v1), `middle`, `first` seconds later, to `second`
/// seconds after that; with r = second / first and w = r^2 / (1 + 2 r)
///   x* = x1 + w (x1 - x0),  v* = v1 + w (v1 - v0),  a = second (1 + r) / (1 + 2 r).
/// @param motion null: not needed @param base gets x* and v*
/// @param velocities gets the mean ones between `before` and `middle` (m/s); may be the latter's
StageStart startBdf2(const ClothState& before, const ClothState& middle, double first,
                     double second, RecentMotion* motion, ClothState& base, Velocities& velocities);

/// The system of a solve without forces, for the change of the velocities: M, -M (v - v*).
/// @param pool null: one thread
void setInertia(const Cloth& cloth, const ClothState& base, const Velocities& velocities,
                linear::ThreadPool* pool, linear::SymmetricBlockMatrix& matrix,
                linear::BlockVector& rhs);

}  // namespace haptex::cloth
