#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fabric_file_fixtures.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material::test_fabric_file {
namespace {

TEST(FabricFile, ReadsEveryProperty) {
  const TemporaryFile file(kValid);
  const Fabric fabric = loadFabric(file.path());
  EXPECT_EQ(fabric.name, "sample");
  EXPECT_EQ(fabric.description, "");
  EXPECT_EQ(fabric.areal_density, 0.2);
  EXPECT_DOUBLE_EQ(fabric.weft.elastic.evaluate(0.3).stress, 30.0);
  EXPECT_TRUE(fabric.weft.viscous.isZero());
  EXPECT_DOUBLE_EQ(fabric.warp.viscous.evaluate(2.0).stress, 5.0);
  EXPECT_TRUE(fabric.shear.viscous.isZero());
}

TEST(FabricFile, ReadsTheDescription) {
  const TemporaryFile file("description: worn\n" + kValid);
  EXPECT_EQ(loadFabric(file.path()).description, "worn");
}

TEST(FabricFile, KeepsTheProvenanceOfEveryProperty) {
  const TemporaryFile file(kValid);
  const auto provenance = loadFabric(file.path()).provenance;
  ASSERT_EQ(provenance.size(), 5u);
  EXPECT_EQ(provenance.at("areal_density").kind, Provenance::Kind::kMeasured);
  EXPECT_EQ(provenance.at("areal_density").source, "scales");
  EXPECT_EQ(provenance.at("weft.elastic").kind, Provenance::Kind::kMeasured);
  EXPECT_EQ(provenance.at("warp.elastic").source, "tester");
  EXPECT_EQ(provenance.at("warp.viscous").kind, Provenance::Kind::kRepresentative);
  EXPECT_EQ(provenance.at("shear.elastic").source, "a similar fabric");
}

TEST(FabricFile, LeavesOutWhatASceneWithoutContactDoesNotNeed) {
  const TemporaryFile file(kValid);
  const Fabric fabric = loadFabric(file.path());
  EXPECT_FALSE(fabric.bending || fabric.compression || fabric.friction);
}

TEST(FabricFile, ReadsBendingCompressionAndFrictionWithTheirProvenance) {
  const TemporaryFile file(kFull);
  const Fabric fabric = loadFabric(file.path());
  ASSERT_TRUE(fabric.bending && fabric.compression && fabric.friction);
  EXPECT_EQ(fabric.bending->weft, 6e-6);
  EXPECT_EQ(fabric.bending->warp, 9e-6);
  EXPECT_EQ(*fabric.friction, 0.25);
  // 50 gf/cm2 at Tm.
  const double strain = 1.0 - 4.5e-4 / fabric.compression->thickness;
  EXPECT_NEAR(fabric.compression->pressure.evaluate(strain).stress, 4903.325, 1e-8);
  ASSERT_EQ(fabric.provenance.size(), 8u);
  EXPECT_EQ(fabric.provenance.at("bending").source, "KES-FB2");
  EXPECT_EQ(fabric.provenance.at("compression").kind, Provenance::Kind::kMeasured);
  EXPECT_EQ(fabric.provenance.at("friction").kind, Provenance::Kind::kRepresentative);
}

TEST(FabricFile, ReadsTheHysteresisOfBendingWithItsProvenance) {
  EXPECT_FALSE(loadFabric(TemporaryFile(kFull).path()).bending_hysteresis);
  std::string text = kFull;
  const std::string rigidity = "warp: 9e-6";
  text.replace(text.find(rigidity), rigidity.size(), rigidity + ", " + hysteresisOf("N", "1e-4"));
  const Fabric fabric = loadFabric(TemporaryFile(text).path());
  ASSERT_TRUE(fabric.bending_hysteresis);
  EXPECT_EQ(fabric.bending_hysteresis->weft, 1e-4);
  EXPECT_EQ(fabric.bending_hysteresis->warp, 2e-4);
  EXPECT_EQ(fabric.provenance.at("bending.hysteresis").source, "its loops");
}

TEST(FabricFile, ReadsTheHysteresisOfStretchAndShearWithItsProvenance) {
  const Fabric without = loadFabric(TemporaryFile(kFull).path());
  EXPECT_FALSE(without.resilience || without.shear_hysteresis);
  const TemporaryFile file(kValid + shearHysteresisOf("N/m", "0.5") + resilienceOf("0.65"));
  const Fabric fabric = loadFabric(file.path());
  ASSERT_TRUE(fabric.resilience && fabric.shear_hysteresis);
  EXPECT_EQ(fabric.resilience->weft, 0.65);
  EXPECT_EQ(fabric.resilience->warp, 0.7);
  EXPECT_EQ(fabric.shear_hysteresis->at_half_degree, 0.5);
  EXPECT_EQ(fabric.shear_hysteresis->at_five_degrees, 1.5);
  EXPECT_EQ(fabric.provenance.at("resilience").source, "KES-FB1");
  EXPECT_EQ(fabric.provenance.at("shear.hysteresis").source, "its loops");
}

const std::string kContraction =
    "contraction: {provenance: measured, source: video of a tensile test, value: 0.3}\n";

TEST(FabricFile, ReadsContractionWithItsProvenance) {
  EXPECT_FALSE(loadFabric(TemporaryFile(kFull).path()).contraction);
  const TemporaryFile file(kFull + kContraction);
  const Fabric fabric = loadFabric(file.path());
  EXPECT_EQ(fabric.contraction, 0.3);
  EXPECT_EQ(fabric.provenance.at("contraction").kind, Provenance::Kind::kMeasured);
}

// The weft is straight, so only the slopes of the warp count, which are sampled here.
TEST(FabricFile, RefusesAContractionThatLeavesTheEnergyNotConvex) {
  const StrainStressCurve warp = loadFabric(TemporaryFile(kFull).path()).warp.elastic;
  double least = warp.evaluate(0.0).slope;
  for (int i = 0; i <= 100000; ++i) {
    least = std::min(least, warp.evaluate(0.25 * i / 100000).slope);
  }
  const double largest = std::sqrt(least / warp.evaluate(0.0).slope);
  const auto with = [](const std::string& value) {
    return replaced(kFull + kContraction, "value: 0.3", "value: " + value);
  };
  EXPECT_NO_THROW(loadFabric(TemporaryFile(with(std::to_string(largest - 1e-5))).path()));
  for (const std::string& value :
       {std::string("-0.1"), std::string(".nan"), std::to_string(largest + 1e-5)}) {
    EXPECT_THROW(loadFabric(TemporaryFile(with(value)).path()), std::invalid_argument) << value;
  }
  const TemporaryFile file(with("1.2"));
  try {
    loadFabric(file.path());
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(), file.path() + ": contraction.value: '1.2' must be >= 0 and < " +
                                std::to_string(largest) +
                                ": at more weft and warp of these curves would give way together");
  }
}

TEST(FabricFile, ReadsCompressionPoints) {
  std::string text = replaced(kFull, "m and J/m2", "Pa and m");
  text = replaced(text, "kes: {T0: 7e-4, Tm: 4.5e-4, WC: 0.2}", "points: [[0, 1e-3], [800, 6e-4]]");
  const TemporaryFile file(text);
  const Fabric fabric = loadFabric(file.path());
  ASSERT_TRUE(fabric.compression);
  EXPECT_EQ(fabric.compression->thickness, 1e-3);
  EXPECT_NEAR(fabric.compression->pressure.evaluate(0.4).stress, 800.0, 1e-9);
}

TEST(FabricFile, ConvertsTesterPointsExactly) {
  const TemporaryFile file(kValid);
  const StrainStressCurve curve = loadFabric(file.path()).warp.elastic;
  EXPECT_NEAR(curve.evaluate(0.105).stress, 10.0, 1e-13);  // 11 N/m at l = 1.1
  EXPECT_NEAR(curve.evaluate(0.22).stress, 20.0, 1e-13);   // 24 N/m at l = 1.2
  EXPECT_DOUBLE_EQ(curve.lastKnot(), 0.22);
}

TEST(FabricFile, ContinuesShearOddlyAndThreadDirectionsLinearly) {
  const TemporaryFile file(kValid);
  const Fabric fabric = loadFabric(file.path());
  EXPECT_NEAR(fabric.shear.elastic.evaluate(-0.2).stress, -10.0, 1e-13);
  EXPECT_NEAR(fabric.shear.elastic.evaluate(-0.1).stress, -4.0, 1e-13);
  EXPECT_DOUBLE_EQ(fabric.warp.elastic.evaluate(-0.2).stress, -0.2 * 10.0 / 0.105);
}

TEST(FabricFile, ReadsPolynomials) {
  const TemporaryFile file(
      replaced(kValid, "modulus: 100",
               "polynomials: {knots: [0, 0.5, 1], coefficients: [[0, 1, 1, 0], [0.75, 2, 1, 0]]}"));
  const StrainStressCurve curve = loadFabric(file.path()).weft.elastic;
  for (const double strain : {0.1, 0.6, 1.0}) {
    EXPECT_NEAR(curve.evaluate(strain).stress, strain + strain * strain, 1e-15);
  }
}

TEST(FabricFile, AcceptsViscousCurvesThatDissipate) {
  const std::string levels = replaced(
      kValid, "modulus: 2.5",
      "quantity: second_piola_kirchhoff_over_green_lagrange, points: [[-1, -2], [1, 2], [2, 2]]");
  EXPECT_NO_THROW(loadFabric(TemporaryFile(levels).path()));
  const std::string cubic = replaced(
      kValid, "modulus: 2.5", "polynomials: {knots: [-1, 1], coefficients: [[-1, 3, -3, 1]]}");
  EXPECT_NO_THROW(loadFabric(TemporaryFile(cubic).path()));  // rate^3, level at zero
}

}  // namespace
}  // namespace haptex::material::test_fabric_file
