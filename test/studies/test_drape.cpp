#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/base/constants.h"
#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/studies/drape.h"
#include "haptex/studies/drape_shadow.h"

namespace haptex::studies::test_drape {
namespace {

material::Fabric wool() {
  return material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool_tropical.yaml");
}

DrapeTest coarse() {
  DrapeTest test;
  test.cell = base::unlessSanitized(4e-3, 8e-3);
  return test;
}

/// Deflection (m, downwards) of the rim of an annular plate without transverse contraction that is
/// clamped at `inner` and free at `outer` (m), under its weight: the axisymmetric solution
///   w = c0 + c1 r^2 + c2 ln r + c3 r^2 ln r + p r^4,  p = weight / (64 rigidity)
/// of the biharmonic equation, which neither moment nor shear force at the rim leave (Timoshenko
/// and Woinowsky-Krieger 1959, sec. 17).
double annulusDeflection(double inner, double outer, double weight, double rigidity) {
  const double p = weight / (64.0 * rigidity);
  const double c3 = -8.0 * p * outer * outer;  // no shear force: (laplacian w)' = 0
  const auto slope = [&](double r) {           // of the known terms
    return c3 * (2.0 * r * std::log(r) + r) + 4.0 * p * r * r * r;
  };
  const double bend = c3 * (2.0 * std::log(outer) + 3.0) + 12.0 * p * outer * outer;
  // 2 c1 - c2 / outer^2 = -bend at the rim, 2 c1 inner + c2 / inner = -slope at the clamp.
  const double c2 = (bend - slope(inner) / inner) / (1.0 / (inner * inner) + 1.0 / (outer * outer));
  const double c1 = 0.5 * (c2 / (outer * outer) - bend);
  const auto deflection = [&](double r) {
    return c1 * r * r + c2 * std::log(r) + c3 * r * r * std::log(r) + p * r * r * r * r;
  };
  return deflection(outer) - deflection(inner);
}

TEST(Drape, StiffDiscSagsAsAClampedAnnularPlate) {
  material::Fabric fabric = wool();
  fabric.bending_hysteresis.reset();
  fabric.bending->weft = fabric.bending->warp = 1e4 * fabric.bending->weft;
  DrapeTest test;
  test.cell = 4e-3;
  test.rest_speed = 1e-7;
  const DrapeOutcome outcome = drape(fabric, test, 1);
  double height = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < outcome.shape.initial_positions.size(); ++i) {
    if (outcome.shape.initial_positions[i].head<2>().norm() < test.fabric_radius - 2e-3) continue;
    height += outcome.shape.initial_positions[i].z();
    ++count;
  }
  const double exact =
      annulusDeflection(test.support_radius, test.fabric_radius,
                        fabric.areal_density * base::kStandardGravity, fabric.bending->weft);
  EXPECT_NEAR(exact, 60.7e-6, 0.1e-6);  // of the same equations solved numerically
  // 1 % of what the clamp and the rim of such a mesh leave open, and as much for the disc off
  // centre.
  EXPECT_NEAR(-height / count, exact, 0.02 * exact);
}

TEST(Drape, EndsAtRestOutsideOfTheSupport) {
  DrapeTest test = coarse();
  for (const Descent descent : {Descent::kByWeight, Descent::kOnPlane}) {
    test.descent = descent;
    const DrapeOutcome outcome = drape(wool(), test, 1);
    EXPECT_LT(outcome.fastest, test.rest_speed);
    EXPECT_EQ(outcome.inside_support, 0);
    EXPECT_GT(outcome.coefficient, 0.2);
    EXPECT_LT(outcome.coefficient, 0.8);
    EXPECT_LT(outcome.energy, 0.0);
  }
}

TEST(Drape, IsTheSameForTheSameSeedOnly) {
  const double first = drape(wool(), coarse(), 1).coefficient;
  EXPECT_EQ(drape(wool(), coarse(), 1).coefficient, first);
  EXPECT_NE(drape(wool(), coarse(), 2).coefficient, first);
}

TEST(Drape, DoesNotDependOnTheTimeStep) {
  DrapeTest test = coarse();
  const double coefficient = drape(wool(), test, 1).coefficient;
  for (const double time_step : {0.0125, 0.005}) {
    if (base::kSanitized && time_step < 0.01) break;
    test.time_step = time_step;
    EXPECT_NEAR(drape(wool(), test, 1).coefficient, coefficient, 0.01) << time_step;
  }
}

/// Of poplin, whose 2HB is large: that of wool is small enough for the number of folds to decide.
TEST(Drape, InternalFrictionHoldsTheFabricUp) {
  const material::Fabric poplin =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/cotton_poplin.yaml");
  material::Fabric without = poplin;
  without.bending_hysteresis.reset();
  EXPECT_GT(drape(poplin, coarse(), 1).coefficient, drape(without, coarse(), 1).coefficient + 0.05);
}

TEST(Drape, RefusesWhatIsNoTest) {
  const auto refusal = [](const material::Fabric& fabric, const DrapeTest& test) -> std::string {
    return test::refusalOf([&] { drape(fabric, test, 1); });
  };
  for (double DrapeTest::*member :
       {&DrapeTest::fabric_radius, &DrapeTest::support_radius, &DrapeTest::cell,
        &DrapeTest::time_step, &DrapeTest::damping, &DrapeTest::lowering_time,
        &DrapeTest::rest_speed, &DrapeTest::most_time}) {
    for (const double value : {0.0, -1.0, std::nan(""), double(INFINITY)}) {
      DrapeTest test = coarse();
      test.*member = value;
      EXPECT_NE(refusal(wool(), test).find("of the drape test is "), std::string::npos) << value;
    }
  }
  DrapeTest test = coarse();
  test.support_radius = test.fabric_radius;
  EXPECT_NE(refusal(wool(), test).find("support_radius"), std::string::npos);
  material::Fabric limp = wool();
  limp.bending.reset();
  EXPECT_NE(refusal(limp, coarse()), test::kNotRefused);
}

TEST(DrapeCoefficient, IsTheShareOfTheRingInTheShadow) {
  const std::vector<double> flat(360, 0.127), hanging(360, 0.0635);
  EXPECT_NEAR(drapeCoefficient(flat, 0.127, 0.0635), 1.0, 1e-12);
  EXPECT_NEAR(drapeCoefficient(hanging, 0.127, 0.0635), 0.0, 1e-12);
  // The polygon around the flat disc lies inside of its circle.
  const std::vector<double> radii = shadowRadii(mesh::makeDisc(0.127, 12), 720);
  EXPECT_NEAR(drapeCoefficient(radii, 0.127, 0.0635), 1.0, 3e-3);
  EXPECT_LT(drapeCoefficient(radii, 0.127, 0.0635), 1.0);
}

TEST(CountNodes, CountsWhatStandsOut) {
  std::vector<double> radii(720);
  for (int folds : {0, 1, 5, 8}) {
    for (int i = 0; i < 720; ++i) {
      const double angle = 2.0 * M_PI * i / 720;
      radii[i] = 0.1 + 0.004 * std::cos(folds * angle + 1.0) + 5e-4 * std::cos(40.0 * angle);
    }
    EXPECT_EQ(countNodes(radii, 2e-3), folds);
  }
  EXPECT_EQ(countNodes({}, 2e-3), 0);
}

}  // namespace
}  // namespace haptex::studies::test_drape
