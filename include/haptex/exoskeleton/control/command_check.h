// Which force commands can be believed: those of a passive object of a possible size.
#pragma once

#include <Eigen/Core>
#include <string>

#include "haptex/exoskeleton/control/force_command.h"

namespace haptex::exoskeleton {

/// Bounds of a command's numbers. A fingertip of 9 mm that is pressed into a fabric by its whole
/// radius has 18 N, 4100 N/m and 37 N s/m (contact::PulpSettings), one of 0.1 m that is pressed in
/// by 10 mm 250 N, 50000 N/m and 500 N s/m; the device renders 5 N and a steady 2000 N/m.
constexpr double kMaxCommandedForce = 1000.0;   ///< N, norm
constexpr double kMaxCommandedStiffness = 1e5;  ///< N/m, Frobenius norm
constexpr double kMaxCommandedDamping = 1e3;    ///< N s/m, Frobenius norm
constexpr double kFarthestPosition = 10.0;      ///< m, norm
constexpr double kFastestVelocity = 100.0;      ///< m/s, norm
/// By how much a stiffness or damping may differ from its transpose, and its smallest eigenvalue be
/// below zero: of its norm. What is left of a positive semidefinite matrix after a turn is 1e-15.
constexpr double kMatrixTolerance = 1e-6;

enum class CommandFlaw {
  kNone,
  kNotFinite,
  kTooLarge,  ///< beyond one of the bounds above
  /// Stiffness or damping is not symmetric or not positive semidefinite. The driver holds a command
  /// while the next one is late: one that gives energy would go on giving it.
  kActive,
};

/// The first that is wrong with a command. Does not allocate; no number makes it overflow.
CommandFlaw findFlaw(const ForceCommand& command);

/// The number that findFlaw() found, and what is allowed; empty for kNone.
std::string explainFlaw(const ForceCommand& command);

}  // namespace haptex::exoskeleton
