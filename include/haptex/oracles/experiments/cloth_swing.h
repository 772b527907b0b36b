// A sheet that swings from its bar once a second, with exact energies to compare with.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/step.h"

namespace haptex::oracles {

/// A narrow sheet hanging from its top edge, 359 mm long, so that it swings in its slowest mode
/// with 1 Hz: a hanging chain of length L does so with the angular frequency 1.2024 sqrt(g / L)
/// and in the shape J0(2 omega sqrt(s / g)), s from the lower end (D. Bernoulli 1733). It starts
/// at rest, displaced in this shape. No viscosity, no air, no bending: the energy is constant.
class ClothSwing {
 public:
  /// @param fabric     whose warp curve rises
  /// @param cells      along the length, > 0; they are square
  /// @param amplitude  m, of the lower end; at most 0.1, beyond which the lowest row cannot be so
  ///   slanted
  /// @throws std::invalid_argument if cells or amplitude are not in their range
  ClothSwing(const material::Fabric& fabric, int cells, double amplitude);

  /// Energy above that at rest (J).
  double energy(const cloth::ClothState& state) const;
  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& start() const { return start_; }

  struct Motion {
    cloth::ClothState end;
    std::vector<double> energies;  ///< J, at the start and after each step
    bool accepted = true;          ///< every step
  };
  Motion swing(const cloth::StepSettings& settings, double duration, int steps) const;

 private:
  cloth::Cloth cloth_;
  cloth::ClothState start_;
  double energy_at_rest_ = 0.0;
};

}  // namespace haptex::oracles
