#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "../refusal.h"
#include "haptex/kes/virtual_kes.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/fabric_file.h"

namespace haptex::kes::test_virtual_kes {
namespace {

material::Fabric shipped(const std::string& name) {
  return material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml");
}

std::string refusal(const material::Fabric& fabric, const std::string& test) {
  std::ostringstream out;
  return test::refusalOf([&] { printKes(fabric, test, out); });
}

double measured(const KesResult& result, const std::string& name) {
  for (const KesParameter& parameter : result.parameters) {
    if (parameter.name == name) return parameter.measured;
  }
  return std::nan("");
}

// Tensile and shear, and all curves, are lines of validate; these are cheap enough to try out.

TEST(VirtualKes, FindsTheRigiditiesOfAnAnisotropicFabric) {
  material::Fabric fabric = shipped("wool");
  fabric.bending = {2e-5, 5e-6};  // N.m
  fabric.bending_hysteresis.reset();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e5);
  const KesResult result = kesBending(fabric);
  EXPECT_NEAR(measured(result, "B/weft"), 2e-5 / 9.80665e-5, 0.02 * 2e-5 / 9.80665e-5);
  EXPECT_NEAR(measured(result, "B/warp"), 5e-6 / 9.80665e-5, 0.02 * 5e-6 / 9.80665e-5);
  EXPECT_NEAR(measured(result, "2HB/weft"), 0.0, 1e-8);  // no hysteresis in, none out
  // A polygon for a circle, 0.4 mm from row to row: B sin(angle) / 0.4 mm. The strip also shortens,
  // by B curvature^2 / modulus, 1.3e-5 of its length at most.
  for (const KesPoint& point : result.points) {
    const double angle = 4e-4 * point.x;
    const double exact = point.x == 0.0 ? 0.0 : point.put_in * std::sin(angle) / angle;
    EXPECT_NEAR(point.simulated, exact, 1e-4 * std::abs(exact) + 1e-10);
  }
}

// 2HB is what went in, and the loop lies on both sides of the elastic line.
TEST(VirtualKes, FindsTheHysteresisOfBendingBesideTheRigidity) {
  material::Fabric fabric = shipped("wool");
  fabric.bending = {2e-5, 5e-6};               // N.m
  fabric.bending_hysteresis = {1.2e-3, 3e-4};  // N
  const KesResult result = kesBending(fabric);
  constexpr double kRigidityUnit = 9.80665e-5, kMomentUnit = 9.80665e-3;
  EXPECT_NEAR(measured(result, "B/weft") * kRigidityUnit, 2e-5, 0.02 * 2e-5);
  EXPECT_NEAR(measured(result, "B/warp") * kRigidityUnit, 5e-6, 0.02 * 5e-6);
  EXPECT_NEAR(measured(result, "2HB/weft") * kMomentUnit, 1.2e-3, 0.02 * 1.2e-3);
  EXPECT_NEAR(measured(result, "2HB/warp") * kMomentUnit, 3e-4, 0.02 * 3e-4);
  for (const KesParameter& parameter : result.parameters) EXPECT_LT(parameter.error(), 0.02);
}

// The cycles are really run. Stretched for the first time the fabric is on its curve, so that its
// work stays what it was.
TEST(VirtualKes, FindsTheHysteresisOfStretchAndShearBesideTheCurves) {
  material::Fabric fabric = shipped("cotton_poplin");
  fabric.resilience = {0.4, 0.8};
  fabric.shear_hysteresis = {1.2, 3.0};  // N/m
  const KesResult tensile = kesTensile(fabric), shear = kesShear(fabric);
  EXPECT_NEAR(measured(tensile, "RT/weft"), 40.0, 0.02 * 40.0);
  EXPECT_NEAR(measured(tensile, "RT/warp"), 80.0, 0.02 * 80.0);
  for (const char* direction : {"weft", "warp"}) {
    const std::string of = std::string("/") + direction;
    EXPECT_NEAR(measured(shear, "2HG" + of), 1.2 / kKesGramPerCentimetre, 0.02 * 1.2);
    EXPECT_NEAR(measured(shear, "2HG5" + of), 3.0 / kKesGramPerCentimetre, 0.02 * 3.0);
  }
  for (const KesResult* result : {&tensile, &shear}) {
    for (const KesParameter& parameter : result->parameters) {
      EXPECT_LT(std::abs(parameter.error()), 0.02) << parameter.name;
    }
    for (const KesPoint& point : result->points) {
      EXPECT_NEAR(point.simulated, point.put_in, 1e-3 * kKesTensileLoad) << point.x;
    }
  }
}

TEST(VirtualKes, CompressesAsTheCurveSaysAndRecoversLessThanAll) {
  const material::Fabric fabric = shipped("wool");
  const KesResult result = kesCompression(fabric);
  EXPECT_NEAR(measured(result, "T0"), 0.41, 1e-5);  // mm, as in the file
  EXPECT_NEAR(measured(result, "TM"), 0.31, 1e-5);
  EXPECT_NEAR(measured(result, "WC") * 0.980665, 0.074, 1e-5);  // J/m2
  EXPECT_LT(measured(result, "RC"), 100.0);
  EXPECT_GT(measured(result, "RC"), 99.9);
}

TEST(VirtualKes, SlidesWithTheFrictionAndStrokesTheRoughnessOfTheFile) {
  for (const char* name : {"wool", "denim", "silk_habutae"}) {
    const material::Fabric fabric = shipped(name);
    for (const KesParameter& parameter : kesSurface(fabric).parameters) {
      EXPECT_NEAR(parameter.measured, parameter.put_in, 1e-9 * parameter.put_in) << name;
    }
  }
}

TEST(VirtualKes, MovingShowsTheViscosityOfTheCurves) {
  const material::Fabric wool = shipped("wool");
  TensileRig tensile(wool, Direction::kWeft);
  tensile.pull(0.05);
  const double at_rest = tensile.force();
  tensile.move(0.2);
  // l g(l l') per width.
  EXPECT_NEAR(tensile.force() - at_rest, 0.2 * 1.05 * wool.weft.viscous.evaluate(1.05 * 0.2).stress,
              1e-9);
  ShearRig shear(wool, Direction::kWarp);
  shear.shear(0.05, 1.0);
  const double along = shear.force().along;
  shear.move(0.3, 0.0);
  // The jaw moves along warp and the pulled weft threads, V.V' being 0: suv' = 0.3, suu' = 0.05
  // 0.3.
  const double viscous = wool.shear.viscous.evaluate(0.3).stress +
                         0.05 * wool.weft.viscous.evaluate(0.05 * 0.3).stress;
  EXPECT_NEAR(shear.force().along - along, 0.2 * viscous, 1e-9);
}

TEST(VirtualKes, PrintsCurvesAndParametersThatProgramsCanRead) {
  std::ostringstream out;
  printKes(shipped("wool"), "bending", out);
  std::istringstream lines(out.str());
  std::string line;
  std::set<std::string> kinds;
  while (std::getline(lines, line)) {
    if (line[0] == '#') continue;
    std::istringstream fields(line);
    std::string kind, field;
    int count = 1;
    std::getline(fields, kind, '\t');
    while (std::getline(fields, field, '\t')) ++count;
    EXPECT_EQ(count, 6) << line;
    kinds.insert(kind);
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"curve", "parameter"}));
}

TEST(VirtualKes, RefusesTestsThatDoNotExistAndFabricsThatLackWhatTheyAreAbout) {
  const material::Fabric wool = shipped("wool");
  EXPECT_EQ(refusal(wool, "tearing"),
            "there is no test 'tearing'; there are: tensile shear bending compression surface");
  material::Fabric bare = wool;
  bare.bending.reset();
  bare.compression.reset();
  bare.surface.reset();
  EXPECT_EQ(refusal(bare, "bending"), "fabric 'wool' has no bending rigidity: add the key bending");
  EXPECT_EQ(refusal(bare, "compression"), "fabric wool: contact needs the property 'compression'");
  EXPECT_EQ(refusal(bare, "surface"), "fabric 'wool' has no surface: add the key surface");
  for (const KesTest& test : kesTests()) {
    EXPECT_EQ(test.possible(bare), test.name == "tensile" || test.name == "shear") << test.name;
    EXPECT_TRUE(test.possible(wool)) << test.name;
  }
}

}  // namespace
}  // namespace haptex::kes::test_virtual_kes
