// The conditions of the KES tests that readings depend on, in SI units.
#pragma once

#include "haptex/material/fabric.h"

namespace haptex::material {

// Kawabata 1980, The Standardization and Analysis of Hand Evaluation, 2nd edition, Textile
// Machinery Society of Japan.
constexpr double kKesGramPerCentimetre = 0.980665;               ///< N/m, 1 gf/cm
constexpr double kKesTensileLoad = 500 * kKesGramPerCentimetre;  ///< N/m
constexpr double kKesShearTension = 10 * kKesGramPerCentimetre;  ///< N/m

/// The shear strain U.V of a sample at a shear angle when the tester's tension pulls its threads,
/// by their curve: with the shear a and the height b, b s((a^2 + b^2 - 1) / 2) is the tension and
/// a / b the tangent of the angle.
/// @param pulled whose elastic curve rises @param angle degrees, within 60 either way
/// @throws std::invalid_argument naming another angle; std::runtime_error if the threads give way
///   to the tension by more than 2000 %
double exactShearStrain(const MembraneCurves& pulled, double angle);

}  // namespace haptex::material
