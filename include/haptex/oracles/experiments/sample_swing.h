// A hanging sample that is held aside and let go, as a person would do it.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/material/fabric.h"

namespace haptex::oracles {

/// A square sample of 0.2 m with the bending and the viscosity of its fabric. It hangs from its top
/// edge, lies on a board that is turned about this edge, and the board is taken away: it starts at
/// rest, straight, and as taut as on the board. Stiff fabrics then turn by up to 0.1 rad in a step
/// of 12.5 ms, stretching by 1e-5.
class SampleSwing {
 public:
  /// @param cells along each side, > 0
  /// @param angle rad, of the board against the vertical, less than pi/2
  /// @throws std::invalid_argument if cells or angle are not in their range
  SampleSwing(const material::Fabric& fabric, int cells, double angle);

  /// Energy above that at rest (J).
  double energy(const cloth::ClothState& state) const;
  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& start() const { return start_; }

  struct Motion {
    cloth::ClothState end;
    double kept = 0.0;     ///< of the energy at the start
    double solves = 0.0;   ///< linear ones per step
    double seconds = 0.0;  ///< of computing per step
    int taken_anew = 0;    ///< steps (StepReport)
    bool accepted = true;  ///< every step
  };
  Motion swing(const cloth::StepSettings& settings, double duration, int steps) const;

 private:
  cloth::Cloth cloth_;
  cloth::ClothState start_;
  double energy_at_rest_ = 0.0;
};

/// How the errors of positions fall with the step, as an exponent, over a decade of steps: RMS over
/// particles after `duration`, with steps of 12.5 and 1.25 ms, against steps of 0.25 ms.
/// @param duration s, a multiple of 12.5 ms
double orderOfSwing(const SampleSwing& swing, const cloth::StepSettings& settings, double duration);

}  // namespace haptex::oracles
