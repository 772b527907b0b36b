// What became of an extreme case.
#pragma once

#include <string>

namespace haptex::studies {

/// How a case with an implicit integrator failed, the gravest first.
enum class ExtremeFailure {
  kThrew,       ///< an exception
  kNotFinite,   ///< a number of the state, an energy or a fingertip's force is not finite
  kStuck,       ///< the last steps were rejected: the simulation did not go on
  kEnergyGrew,  ///< in steps in which nothing did work on the cloth
  kIntersects,  ///< cloth that collides with itself, after a state without intersections
  kNoReturn,    ///< neither at the rest state at the end nor at another one
  kNone,
};

const char* nameOf(ExtremeFailure failure);

/// Largest growth of energy in steps without work that counts as rounding, over the scale of the
/// energies: kinetic and potential before and after, and what the sheet weighs times how far it
/// hangs from the origin, to which gravity's energy refers.
constexpr double kRoundingGrowth = 1e-10;
/// With pulling tangles apart this is without what that adds (cloth::TangleReport).
/// Largest distance of a particle from its place at rest, over the sheet's largest extent at rest,
/// that counts as returned.
constexpr double kReturnTolerance = 1e-3;

/// Largest force on a free particle, or on a group of them within the tolerance of each other, over
/// the largest on an attached one, of a cloth that counts as at rest elsewhere.
constexpr double kBalanced = 1e-3;

struct ExtremeOutcome {
  ExtremeFailure failure = ExtremeFailure::kNone;
  std::string message;        ///< of an exception
  int steps = 0;              ///< until the cloth was let settle
  int rejected = 0;           ///< steps, of all
  double growth = 0.0;        ///< beyond the energy before the last steps (EnergyWatch), of steps
                              ///< without work; the largest, over the scale of the energies
  double return_error = 0.0;  ///< over the extent at rest; 0 if it was not looked at
  int settling_steps = 0;     ///< until the cloth was back
  bool slow = false;          ///< it came back with more solves per step only
  bool other_rest = false;    ///< it has come to rest elsewhere: folded, needles turned over
  bool unsettled = false;     ///< cloth that collides with itself was still moving at the end
};

}  // namespace haptex::studies
