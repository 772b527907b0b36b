// A fabric from what testers have read of it, before it is written as a fabric file.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "haptex/material/compression.h"
#include "haptex/material/fabric.h"
#include "haptex/material/monotone_fit.h"
#include "haptex/material/tester_file.h"

namespace haptex::material {

/// As a fabric file states an elastic curve: polynomials, points (engineering strain, force per
/// width in N/m), or a modulus (N/m).
using StatedCurve = std::variant<PiecewiseCubic, std::vector<CurvePoint>, double>;
/// As a fabric file states compression: points, or KES values.
using StatedCompression = std::variant<std::vector<ThicknessPoint>, KesCompression>;

/// What a property is, and which readings it is from.
template <typename Value>
struct Sourced {
  Value value;
  std::string source;
};

/// What a fabric file made of readings says.
struct TesterFabric {
  std::string name;
  bool measured;
  Sourced<double> areal_density;  ///< kg/m^2
  Sourced<StatedCurve> weft, warp, shear;
  std::optional<Sourced<ShearHysteresis>> shear_hysteresis;
  std::optional<Sourced<TensileResilience>> resilience;
  std::optional<Sourced<BendingRigidity>> bending;
  std::optional<Sourced<BendingHysteresis>> bending_hysteresis;
  std::optional<Sourced<StatedCompression>> compression;
  std::optional<Sourced<double>> friction;
  std::vector<std::string> remarks;  ///< what was read but has no key in fabric files
};

/// How well a fit meets its readings.
struct FittedCurve {
  std::string name;  ///< test/direction
  std::size_t readings;
  int pieces;
  Residuals residuals;
  std::string unit;
};

/// A parameter in the unit in which testers print it.
struct FittedParameter {
  std::string name;  ///< KES name, with /direction
  std::string unit;
  double value;
  std::optional<double> stated;  ///< where the file has a value beside the readings
};

struct FitReport {
  std::vector<FittedCurve> curves;
  std::vector<FittedParameter> parameters;
};

struct TesterFit {
  TesterFabric fabric;
  FitReport report;
};

/// Readings are fitted; what has none is taken from KES values, or else from FAST values:
///   stretch      EMT with LT or WT: F = Fm (exp(a e/EMT) - 1)/(exp(a) - 1) to Fm = 500 gf/cm, with
///   the
///                a of that work; or E5, E20, E100: points at 4.9, 19.6 and 98.1 N/m
///   shear        G; or EB5, the extension on the bias at 5 gf/cm: G = 123 N/m / EB5 in percent
///   bending      B; or the bending length C: B = W g C^3
///   compression  T0, TM with WC or LC; or T2 and T100, at 2 and 100 gf/cm2: van Wyk's law around
///   an
///                incompressible core through both
/// KES: Kawabata 1980. FAST: De Boos and Tester 1994, SiroFAST: Fabric Assurance by Simple Testing,
/// CSIRO report WT92.02.
/// @param pieces of each fitted curve, at least 1
/// @throws std::invalid_argument naming file and property: what is missing and which readings or
///   values it can be from, what does not fit together, and what the fits refuse
TesterFit fitFabric(const TesterFile& file, const std::string& name, int pieces);

}  // namespace haptex::material
