// Fabric files that are refused, and what is said then.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "fabric_file_fixtures.h"
#include "haptex/material/fabric_file.h"

namespace haptex::material::test_fabric_file_refusals {
namespace {

class FabricFileRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(FabricFileRefuses, NamingFileKeyValueAndWhatIsAllowed) { expectRefusal(kFull, GetParam()); }

const std::string kRequired = "name, areal_density, weft, warp, shear";
const std::string kAllowed =
    kRequired +
    ", description, resilience, bending, contraction, compression, friction, surface, look";
const std::string kCurveKeys = "unit, provenance, source, modulus, points, polynomials, quantity";
const std::string kPiola = "second_piola_kirchhoff_over_green_lagrange";
const std::string kDissipate =
    "must have the sign of the rate and not be less than the stress before: a viscous curve must "
    "dissipate";

INSTANTIATE_TEST_SUITE_P(
    Keys, FabricFileRefuses,
    testing::Values(
        Refusal{"UnknownProperty", "name:", "colour: red\nname:", "colour",
                "unknown key, allowed here: " + kAllowed},
        Refusal{"UnknownDirectionKey", "viscous:", "plastic:", "warp.plastic",
                "unknown key, allowed here: elastic, viscous"},
        Refusal{"UnknownCurveKey", "modulus: 100", "moduls: 100", "weft.elastic.moduls",
                "unknown key, allowed here: " + kCurveKeys},
        Refusal{"UnknownDensityKey", "value: 0.2", "value: 0.2, error: 0.1", "areal_density.error",
                "unknown key, allowed here: value, unit, provenance, source"},
        Refusal{"KeyGivenTwice", "name: sample", "name: sample\nname: other", "name",
                "the key is given twice"},
        Refusal{"MissingName", "name: sample", "", "",
                "the key 'name' is missing, required here: " + kRequired},
        Refusal{"MissingDirection", kShear, "", "",
                "the key 'shear' is missing, required here: " + kRequired},
        Refusal{"MissingElastic", kWeft,
                "weft:\n  viscous: {unit: N.s/m, provenance: measured, source: x, modulus: 1}\n",
                "weft", "the key 'elastic' is missing, required here: elastic"},
        Refusal{"MissingUnit", "unit: kg/m2, ", "", "areal_density",
                "the key 'unit' is missing, required here: value, unit, provenance, source"},
        Refusal{"MissingProvenance", "provenance: measured, source: tester", "source: tester",
                "weft.elastic",
                "the key 'provenance' is missing, required here: unit, provenance, source"},
        Refusal{"MissingQuantity", "    quantity: " + kPiola + "\n", "", "shear.elastic",
                "the key 'quantity' is missing, required together with points"},
        Refusal{"QuantityWithoutPoints", "modulus: 100", "modulus: 100, quantity: " + kPiola,
                "weft.elastic.quantity", "is allowed only together with points"},
        Refusal{"NoCurve", ", modulus: 100", "", "weft.elastic",
                "must have exactly one of modulus, points, polynomials"},
        Refusal{"TwoCurves", "modulus: 100", "modulus: 100, polynomials: {}", "weft.elastic",
                "must have exactly one of modulus, points, polynomials"},
        Refusal{"DirectionNotAMap", kWeft, "weft: 100\n", "weft",
                "'100' must be a map with the keys elastic, viscous"},
        Refusal{"FileNotAMap", kFull, "- name\n", "",
                "a list of 1 must be a map with the keys " + kAllowed},
        Refusal{"EmptyFile", kFull, "---\n", "",
                "nothing must be a map with the keys " + kAllowed}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Values, FabricFileRefuses,
    testing::Values(
        Refusal{"NegativeDensity", "value: 0.2", "value: -0.2", "areal_density.value",
                "'-0.2' must be a finite number > 0"},
        Refusal{"ZeroDensity", "value: 0.2", "value: 0", "areal_density.value",
                "'0' must be a finite number > 0"},
        Refusal{"NanDensity", "value: 0.2", "value: .nan", "areal_density.value",
                "'.nan' must be a finite number"},
        Refusal{"OverflowingDensity", "value: 0.2", "value: 1e999", "areal_density.value",
                "'1e999' must be a finite number"},
        Refusal{"TextForANumber", "value: 0.2", "value: light", "areal_density.value",
                "'light' must be a finite number"},
        Refusal{"QuotedNumber", "value: 0.2", "value: '0.2'", "areal_density.value",
                "'0.2' must be a finite number"},
        Refusal{"NumberWithUnit", "value: 0.2", "value: 0.2 kg", "areal_density.value",
                "'0.2 kg' must be a finite number"},
        Refusal{"WrongDensityUnit", "unit: kg/m2", "unit: g/m2", "areal_density.unit",
                "'g/m2' must be kg/m2"},
        Refusal{"WrongElasticUnit", "unit: N/m", "unit: gf/cm", "weft.elastic.unit",
                "'gf/cm' must be N/m"},
        Refusal{"WrongViscousUnit", "unit: N.s/m", "unit: N/m", "warp.viscous.unit",
                "'N/m' must be N.s/m"},
        Refusal{"UnknownProvenance", "provenance: measured, source: scales",
                "provenance: guessed, source: scales", "areal_density.provenance",
                "'guessed' must be one of measured, representative"},
        Refusal{"EmptySource", "source: scales", "source: ''", "areal_density.source",
                "'' must be a text that is not empty"},
        Refusal{"BlankSource", "source: a similar fabric", "source: '  '", "shear.elastic.source",
                "'  ' must be a text that is not empty"},
        Refusal{"NoSource", "source: scales", "source: ", "areal_density.source",
                "nothing must be a text that is not empty"},
        Refusal{"NameNotAText", "name: sample", "name: [a]", "name",
                "a list of 1 must be a text that is not empty"},
        Refusal{"NegativeModulus", "modulus: 100", "modulus: -100", "weft.elastic.modulus",
                "'-100' must be a finite number >= 0"},
        Refusal{"InfiniteModulus", "modulus: 100", "modulus: .inf", "weft.elastic.modulus",
                "'.inf' must be a finite number"},
        Refusal{"NegativeViscousModulus", "modulus: 2.5", "modulus: -1", "warp.viscous.modulus",
                "'-1' must be a finite number >= 0"},
        Refusal{"UnknownQuantity", "quantity: force_per_width_over_engineering_strain",
                "quantity: force", "warp.elastic.quantity",
                "'force' must be one of " + kPiola + ", force_per_width_over_engineering_strain"},
        Refusal{"TesterQuantityForShear", "quantity: " + kPiola,
                "quantity: force_per_width_over_engineering_strain", "shear.elastic.quantity",
                "'force_per_width_over_engineering_strain' must be " + kPiola}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Curves, FabricFileRefuses,
    testing::Values(
        Refusal{"PointsNotAList", "points: [[0.1, 4], [0.2, 10]]", "points: 4",
                "shear.elastic.points", "'4' must be a list"},
        Refusal{"NoPoints", "points: [[0.1, 4], [0.2, 10]]", "points: []", "shear.elastic.points",
                "has 0 points, must have at least one at a strain other than 0"},
        Refusal{"PointNotAPair", "[0.2, 10]", "[0.2, 10, 1]", "shear.elastic.points[1]",
                "a list of 3 must be a list of 2"},
        Refusal{"PointNotANumber", "[0.2, 10]", "[0.2, ten]", "shear.elastic.points[1][1]",
                "'ten' must be a finite number"},
        Refusal{"NanStrain", "[0.2, 24]", "[.nan, 24]", "warp.elastic.points[2][0]",
                "'.nan' must be a finite number"},
        Refusal{"DecreasingStrain", "[0.2, 24]", "[0.05, 24]", "warp.elastic.points[2]",
                "strain 0.05 must be greater than the one before, 0.1"},
        Refusal{"RepeatedStrain", "[0.2, 24]", "[0.1, 24]", "warp.elastic.points[2]",
                "strain 0.1 must be greater than the one before, 0.1"},
        Refusal{"StressAtZero", "[0, 0]", "[0, 3]", "warp.elastic.points[0]",
                "stress 3 at strain 0 must be 0"},
        Refusal{"CollapsedSample", "[0, 0]", "[-1, -5]", "warp.elastic.points[0]",
                "engineering strain -1 must be finite and > -1"},
        Refusal{"TooSteep", "[0.1, 4]", "[1e-300, 1e300]", "shear.elastic",
                "the curve near strain -0.2 is too steep or too large for double arithmetic"},
        Refusal{"StressAgainstTheStrain", "[0.1, 4]", "[0.1, -4]", "shear.elastic.points[0][1]",
                "'-4' must have the sign of the strain: an elastic curve must pull back"},
        Refusal{"FallingEnd", "[0.2, 10]", "[0.2, 3]", "shear.elastic",
                "the curve ends at -0.200000 with the slope -10.000000, it must be >= 0: the curve "
                "continues with it"},
        Refusal{"FallingPolynomialEnd", "modulus: 100",
                "polynomials: {knots: [0, 1], coefficients: [[0, 1, -1, 0]]}",
                "weft.elastic.polynomials",
                "the curve ends at 1.000000 with the slope -1.000000, it must be >= 0: the curve "
                "continues with it"},
        Refusal{"StrainBeyondCollapse", "modulus: 100",
                "quantity: " + kPiola + ", points: [[-0.6, -60], [0.1, 10]]",
                "weft.elastic.points[0][0]",
                "'-0.6' must be >= -0.5, the Green-Lagrange strain of collapse"},
        Refusal{"FallingViscousPoints", "modulus: 2.5",
                "quantity: " + kPiola + ", points: [[1, 2], [2, 1.5]]", "warp.viscous.points[1][1]",
                "'1.5' " + kDissipate},
        Refusal{"ViscousPointsWithTheWrongSign", "modulus: 2.5",
                "quantity: " + kPiola + ", points: [[1, -2], [2, -1]]", "warp.viscous.points[0][1]",
                "'-2' " + kDissipate},
        Refusal{"TesterQuantityForViscous", "modulus: 2.5",
                "quantity: force_per_width_over_engineering_strain, points: [[1, 2]]",
                "warp.viscous.quantity",
                "'force_per_width_over_engineering_strain' must be " + kPiola},
        Refusal{"FallingViscousPolynomials", "modulus: 2.5",
                "polynomials: {knots: [0, 1], coefficients: [[0, 1, -3, 2]]}",
                "warp.viscous.polynomials",
                "the slope falls to -0.500000, it must be >= 0 everywhere: a viscous curve must "
                "dissipate"},
        Refusal{"PolynomialsWithoutKnots", "modulus: 100", "polynomials: {coefficients: []}",
                "weft.elastic.polynomials",
                "the key 'knots' is missing, required here: knots, coefficients"},
        Refusal{"UnknownPolynomialKey", "modulus: 100",
                "polynomials: {knots: [0, 1], coefficients: [[0, 1, 0, 0]], degree: 3}",
                "weft.elastic.polynomials.degree",
                "unknown key, allowed here: knots, coefficients"},
        Refusal{"ThreeCoefficients", "modulus: 100",
                "polynomials: {knots: [0, 1], coefficients: [[0, 1, 0]]}",
                "weft.elastic.polynomials.coefficients[0]", "a list of 3 must be a list of 4"},
        Refusal{"DecreasingKnots", "modulus: 100",
                "polynomials: {knots: [1, 0], coefficients: [[0, 1, 0, 0]]}",
                "weft.elastic.polynomials.knots[1]", "0 must be greater than the one before, 1"},
        Refusal{"JumpAtAKnot", "modulus: 100",
                "polynomials: {knots: [0, 1, 2], coefficients: [[0, 1, 0, 0], [2, 1, 0, 0]]}",
                "weft.elastic.polynomials.knots[1]",
                "the stress jumps by 1 at strain 1, it must be continuous"}),
    [](const auto& info) { return info.param.name; });

const std::string kKes = "kes: {T0: 7e-4, Tm: 4.5e-4, WC: 0.2}";
const std::string kMetres =
    "unit: m and J/m2\n  provenance: measured\n  source: KES-FB3\n  " + kKes;

// The compression with points instead of KES values.
std::string withPoints(const std::string& points) {
  return "unit: Pa and m\n  provenance: measured\n  source: KES-FB3\n  points: " + points;
}

INSTANTIATE_TEST_SUITE_P(
    Contact, FabricFileRefuses,
    testing::Values(
        Refusal{"WrongBendingUnit", "unit: N.m,", "unit: gf.cm2/cm,", "bending.unit",
                "'gf.cm2/cm' must be N.m"},
        Refusal{"BendingInOneDirection", ", warp: 9e-6", "", "bending",
                "the key 'warp' is missing, required here: unit, provenance, source, weft, warp"},
        Refusal{"UnknownBendingKey", "weft: 6e-6", "weft: 6e-6, twist: 1", "bending.twist",
                "unknown key, allowed here: unit, provenance, source, weft, warp, hysteresis"},
        Refusal{"HysteresisOfNothing", "warp: 9e-6", "warp: 9e-6, hysteresis: 1",
                "bending.hysteresis",
                "'1' must be a map with the keys unit, provenance, source, weft, warp"},
        Refusal{"HysteresisWithoutProvenance", "warp: 9e-6",
                "warp: 9e-6, hysteresis: {unit: N, source: KES-FB2, weft: 1e-4, warp: 1e-4}",
                "bending.hysteresis",
                "the key 'provenance' is missing, required here: unit, provenance, source, weft, "
                "warp"},
        Refusal{"HysteresisInAnotherUnit", "warp: 9e-6",
                "warp: 9e-6, " + hysteresisOf("gf.cm/cm", "1e-4"), "bending.hysteresis.unit",
                "'gf.cm/cm' must be N"},
        Refusal{"NegativeHysteresis", "warp: 9e-6", "warp: 9e-6, " + hysteresisOf("N", "-1e-4"),
                "bending.hysteresis.weft", "'-1e-4' must be a finite number >= 0"},
        Refusal{"HysteresisWithoutRigidity", "weft: 6e-6", "weft: 0, " + hysteresisOf("N", "1e-4"),
                "bending.hysteresis.weft", "'1e-4' must be 0, as the rigidity is"},
        Refusal{"NegativeRigidity", "weft: 6e-6", "weft: -6e-6", "bending.weft",
                "'-6e-6' must be a finite number >= 0"},
        Refusal{"NanRigidity", "warp: 9e-6", "warp: .nan", "bending.warp",
                "'.nan' must be a finite number"},
        Refusal{"BendingWithoutSource", ", source: KES-FB2", "", "bending",
                "the key 'source' is missing, required here: unit, provenance, source, weft, warp"},
        Refusal{"CompressionOfNothing", "\n  " + kKes, "", "compression",
                "must have exactly one of points, kes"},
        Refusal{"CompressionTwice", kKes, kKes + "\n  points: []", "compression",
                "must have exactly one of points, kes"},
        Refusal{"UnknownCompressionKey", kKes, kKes + "\n  RC: 50", "compression.RC",
                "unknown key, allowed here: unit, provenance, source, points, kes"},
        Refusal{"KesUnit", "unit: m and J/m2", "unit: mm and gf.cm/cm2", "compression.unit",
                "'mm and gf.cm/cm2' must be m and J/m2"},
        Refusal{"PointsWithTheUnitOfKes", kKes, "points: [[0, 1e-3], [800, 6e-4]]",
                "compression.unit", "'m and J/m2' must be Pa and m"},
        Refusal{"MissingWork", ", WC: 0.2", "", "compression.kes",
                "the key 'WC' is missing, required here: T0, Tm, WC"},
        Refusal{"LinearityForWork", "WC: 0.2", "LC: 0.3", "compression.kes.LC",
                "unknown key, allowed here: T0, Tm, WC"},
        Refusal{"ThickerUnderPressure", "Tm: 4.5e-4", "Tm: 8e-4", "compression.kes.Tm",
                "0.0008 must be > 0 and less than T0, 0.0007"},
        Refusal{"WorkInTheWrongUnit", "WC: 0.2", "WC: 200", "compression.kes.WC",
                "200 must be > 0.0122583 and <= 0.445892 J/m2 for these T0 and Tm: more leaves no "
                "thickness to an incompressible core"},
        Refusal{"CompressionPointNotAPair", kMetres, withPoints("[[0, 1e-3], [5]]"),
                "compression.points[1]", "a list of 1 must be a list of 2"},
        Refusal{"NoThicknessWithoutPressure", kMetres, withPoints("[[5, 1e-3], [9, 8e-4]]"),
                "compression.points[0]", "pressure 5 must be 0: the thickness without pressure"},
        Refusal{"ThicknessThatGrows", kMetres, withPoints("[[0, 1e-3], [9, 2e-3]]"),
                "compression.points[1]", "thickness 0.002 must be less than the one before, 0.001"},
        Refusal{"NoFriction", "value: 0.25", "value: 0", "friction.value",
                "'0' must be a finite number > 0"},
        Refusal{"InfiniteFriction", "value: 0.25", "value: .inf", "friction.value",
                "'.inf' must be a finite number"},
        Refusal{"FrictionWithAUnit", "value: 0.25", "value: 0.25, unit: N/N", "friction.unit",
                "unknown key, allowed here: value, provenance, source"},
        Refusal{"FrictionNotAMap",
                "friction: {provenance: representative, source: a guess, value: 0.25}",
                "friction: 0.25", "friction",
                "'0.25' must be a map with the keys value, provenance, source"}),
    [](const auto& info) { return info.param.name; });

// The shear ends where the bending begins.
const std::string kBending = "bending: {unit";
const std::string kTwoDirections = "provenance, source, weft, warp";

INSTANTIATE_TEST_SUITE_P(
    Hysteresis, FabricFileRefuses,
    testing::Values(
        Refusal{"ResilienceInPercent", "friction:", resilienceOf("65") + "friction:",
                "resilience.weft", "'65' must be a number from 0.1 to 1, KES RT over 100"},
        Refusal{"HardlyAnyResilience", "friction:", resilienceOf("0.09") + "friction:",
                "resilience.weft", "'0.09' must be a number from 0.1 to 1, KES RT over 100"},
        Refusal{"NanResilience", "friction:", resilienceOf(".nan") + "friction:", "resilience.weft",
                "'.nan' must be a finite number"},
        Refusal{"ResilienceWithAUnit", "friction:", resilienceOf("0.6, unit: '%'") + "friction:",
                "resilience.unit", "unknown key, allowed here: " + kTwoDirections},
        Refusal{"ResilienceInOneDirection", "friction:",
                "resilience: {provenance: measured, source: KES, weft: 0.6}\nfriction:",
                "resilience", "the key 'warp' is missing, required here: " + kTwoDirections},
        Refusal{"ResilienceWithoutProvenance", "friction:",
                "resilience: {source: KES, weft: 0.6, warp: 0.6}\nfriction:", "resilience",
                "the key 'provenance' is missing, required here: " + kTwoDirections},
        Refusal{"ShearHysteresisInAnotherUnit", kBending,
                shearHysteresisOf("gf/cm", "0.5") + kBending, "shear.hysteresis.unit",
                "'gf/cm' must be N/m"},
        Refusal{"NegativeShearHysteresis", kBending, shearHysteresisOf("N/m", "-0.5") + kBending,
                "shear.hysteresis.2HG", "'-0.5' must be a finite number >= 0"},
        Refusal{"InfiniteShearHysteresis", kBending, shearHysteresisOf("N/m", ".inf") + kBending,
                "shear.hysteresis.2HG", "'.inf' must be a finite number"},
        Refusal{"ShearHysteresisOfNothing", kBending, "  hysteresis: 1\n" + kBending,
                "shear.hysteresis",
                "'1' must be a map with the keys unit, provenance, source, 2HG, 2HG5"},
        Refusal{"ShearHysteresisAtOneAngle", kBending,
                "  hysteresis: {unit: N/m, provenance: measured, source: KES, 2HG: 1}\n" + kBending,
                "shear.hysteresis",
                "the key '2HG5' is missing, required here: unit, provenance, source, 2HG, 2HG5"},
        Refusal{"UnknownShearKey", kBending, "  resilience: 1\n" + kBending, "shear.resilience",
                "unknown key, allowed here: elastic, viscous, hysteresis"},
        Refusal{"HysteresisOfWeft", "warp:\n", "  hysteresis: {unit: N/m}\nwarp:\n",
                "weft.hysteresis", "unknown key, allowed here: elastic, viscous"}),
    [](const auto& info) { return info.param.name; });

std::string runtimeErrorOf(const std::string& path) {
  return test::refusalOf<std::runtime_error>([&] { loadFabric(path); });
}

TEST(FabricFile, NamesTheFileThatCannotBeRead) {
  const std::string path = testing::TempDir() + "haptex_there_is_no_such_fabric.yaml";
  EXPECT_EQ(runtimeErrorOf(path), path + ": there is no such file");
  EXPECT_EQ(runtimeErrorOf(testing::TempDir()),
            testing::TempDir() + ": is a directory, not a file");
}

TEST(FabricFile, NamesFileAndLineOfASyntaxError) {
  const TemporaryFile file("name: sample\nweft: [1, 2\nwarp: 3\n");
  const std::string message = runtimeErrorOf(file.path());
  EXPECT_EQ(message.rfind(file.path() + ": line 3: is not YAML: ", 0), 0u) << message;
}

TEST(FabricFile, RefusesMoreThanOneDocument) {
  const TemporaryFile file(kValid + "---\n" + kValid);
  EXPECT_EQ(runtimeErrorOf(file.path()), file.path() + ": has 2 YAML documents, must have one");
}

TEST(FabricFile, RefusesAnEmptyFile) {
  const TemporaryFile file("");
  EXPECT_EQ(runtimeErrorOf(file.path()), file.path() + ": has 0 YAML documents, must have one");
}

}  // namespace
}  // namespace haptex::material::test_fabric_file_refusals
