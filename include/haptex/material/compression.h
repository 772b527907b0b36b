// Compression curves of a fabric between two plates, from measured points or from KES values.
#pragma once

#include <vector>

#include "haptex/material/fabric.h"

namespace haptex::material {

/// KES measures thickness at 0.5 gf/cm^2 (T0) and at 50 gf/cm^2 (Tm), 1 gf/cm^2 = 98.0665 Pa.
constexpr double kKesLowPressure = 49.03325;    ///< Pa
constexpr double kKesHighPressure = 4903.325;   ///< Pa
constexpr double kMaxFittedPressure = 2e6;      ///< Pa: compression curves are known up to here
constexpr double kMaxFreeThicknessRatio = 2.0;  ///< of the thickness without pressure to T0

struct ThicknessPoint {
  double pressure;   ///< Pa
  double thickness;  ///< m
};

/// The three numbers that a KES compression tester reports of the loading branch.
struct KesCompression {
  double low_pressure_thickness;   ///< m, T0
  double high_pressure_thickness;  ///< m, Tm
  double work;                     ///< J/m^2, WC: from T0 to Tm
};

/// The monotone C1 curve through the points. Beyond the last one it follows
///   pressure = last pressure (last thickness / thickness)^n
/// up to kMaxFittedPressure, with the n that continues the slope of the last interval: no
/// pressure makes the thickness vanish.
/// @param points at least two: the first at pressure 0, then pressure strictly rising up to at most
///   kMaxFittedPressure and thickness strictly falling, > 0
/// @throws std::invalid_argument naming the offending point by index, its value and what is allowed
Compression compressionFromPoints(const std::vector<ThicknessPoint>& points);

/// The curve that reproduces T0, Tm and WC. From T0 on it is van Wyk's law for fibre assemblies
/// around an incompressible core (van Wyk 1946, J. Text. Inst. 37:T285; as a model of woven fabrics
/// de Jong, Snaith and Michie 1986, Text. Res. J. 56:759) with a constant:
///   pressure = a / (thickness - core)^3 + b,
/// whose three constants follow from T0, Tm and WC in closed form; that gives no thickness less
/// than the core at any pressure. Below 0.5 gf/cm^2, where KES says nothing, it is the tangent at
/// T0 down to pressure 0.
/// @throws std::invalid_argument naming T0, Tm or WC, its value and what is allowed: all finite,
///   0 < Tm < T0, WC so large that the thickness without pressure is at most
///   kMaxFreeThicknessRatio T0, and so small that the core is not negative
Compression compressionFromKes(const KesCompression& kes);

}  // namespace haptex::material
