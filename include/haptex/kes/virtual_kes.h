// The tests of the Kawabata Evaluation System on a simulated fabric, beside what its file says.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/material/kes_conditions.h"

namespace haptex::kes {

/// A point of a curve. What x and y are: docs/virtual_kes.md.
struct KesPoint {
  std::string test;
  std::string direction;
  double x;
  double simulated;
  double put_in;  ///< what the fabric file says there
};

/// A parameter in the unit in which KES testers print it.
struct KesParameter {
  std::string name;
  std::string unit;
  double put_in;
  double measured;

  /// Of the simulated value, relative unless put_in is 0.
  double error() const;
};

struct KesResult {
  std::vector<KesPoint> points;
  std::vector<KesParameter> parameters;
};

// Conditions of the tests (Kawabata 1980, The Standardization and Analysis of Hand Evaluation, 2nd
// edition, Textile Machinery Society of Japan), in SI units.
using material::kKesGramPerCentimetre;
using material::kKesShearTension;
using material::kKesTensileLoad;
constexpr double kKesStrainRate = 4e-3;               ///< 1/s
constexpr double kKesShearRate = 8.34e-3;             ///< 1/s
constexpr double kKesLargestShear = 8.0;              ///< degrees
constexpr double kKesLargestCurvature = 250.0;        ///< 1/m
constexpr double kKesBendingGauge = 0.01;             ///< m, between the clamps
constexpr double kKesCompressionSpeed = 20e-6;        ///< m/s
constexpr double kKesCompressionArea = 2e-4;          ///< m^2
constexpr double kKesFrictionLoad = 50 * 9.80665e-3;  ///< N
constexpr double kKesFrictionSide = 5e-3;             ///< m, of the square contactor
using material::exactShearStrain;

/// The five tests. Hysteresis is that of the simulated cycle: the fabric's own where the file says
/// one (bending, stretch and shear), at rest; elsewhere what comes from viscosity at the rate of
/// the tester.
/// @throws std::invalid_argument if the fabric lacks what the test is about, naming the key;
///   std::runtime_error if a sample does not come to rest
KesResult kesTensile(const material::Fabric& fabric);
KesResult kesShear(const material::Fabric& fabric);
KesResult kesBending(const material::Fabric& fabric);
KesResult kesCompression(const material::Fabric& fabric);
KesResult kesSurface(const material::Fabric& fabric);

struct KesTest {
  std::string name;
  std::function<bool(const material::Fabric&)> possible;  ///< whether the file has what it needs
  KesResult (*run)(const material::Fabric&);
};

/// In the order of the instruments: tensile, shear, bending, compression, surface.
const std::vector<KesTest>& kesTests();

/// Prints the test of that name, or all that are possible, with a comment for each that is not.
/// Lines: "curve test direction x simulated put_in" and "parameter name unit put_in measured
/// error", separated by tabs; comments start with #.
/// @param test empty: all
/// @throws std::invalid_argument if there is no such test, naming those that there are; and what
/// the tests throw
void printKes(const material::Fabric& fabric, const std::string& test, std::ostream& out);

}  // namespace haptex::kes
