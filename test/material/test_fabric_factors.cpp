#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "haptex/material/fabric_factors.h"
#include "haptex/material/fabric_file.h"

namespace haptex::material::test_fabric_factors {
namespace {

Fabric wool() { return loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/wool.yaml"); }

TEST(FabricFactors, MultiplyWhatTheyNameAndNothingElse) {
  const Fabric before = wool();
  const Fabric after = scaledBy({2.0, 3.0, 0.5, 4.0, 1.5}, before);
  const double strain = 0.01;
  EXPECT_DOUBLE_EQ(after.weft.elastic.evaluate(strain).stress,
                   2.0 * before.weft.elastic.evaluate(strain).stress);
  EXPECT_DOUBLE_EQ(after.warp.viscous.evaluate(strain).stress,
                   3.0 * before.warp.viscous.evaluate(strain).stress);
  EXPECT_DOUBLE_EQ(after.shear.elastic.evaluate(strain).stress,
                   0.5 * before.shear.elastic.evaluate(strain).stress);
  EXPECT_DOUBLE_EQ(after.shear_hysteresis->at_five_degrees,
                   0.5 * before.shear_hysteresis->at_five_degrees);
  EXPECT_DOUBLE_EQ(after.bending->weft, 4.0 * before.bending->weft);
  EXPECT_DOUBLE_EQ(after.bending_hysteresis->warp, 4.0 * before.bending_hysteresis->warp);
  EXPECT_DOUBLE_EQ(after.areal_density, 1.5 * before.areal_density);
  EXPECT_EQ(after.friction, before.friction);
  EXPECT_EQ(after.contraction, before.contraction);
  EXPECT_EQ(after.resilience->weft, before.resilience->weft);
  EXPECT_EQ(after.file, before.file);
}

TEST(FabricFactors, OfOneChangeNothing) {
  const Fabric before = wool();
  const Fabric after = scaledBy({}, before);
  for (const double strain : {-0.01, 0.003, 0.05}) {
    EXPECT_EQ(after.warp.elastic.evaluate(strain).stress,
              before.warp.elastic.evaluate(strain).stress);
  }
  EXPECT_EQ(after.areal_density, before.areal_density);
  EXPECT_EQ(FabricFactors(), FabricFactors());
  EXPECT_NE(FabricFactors(), (FabricFactors{1.0, 1.0, 1.0, 1.0, 2.0}));
}

TEST(FabricFactors, AreRefusedByNameBeyondTheirRange) {
  for (const double factor : {0.0, -1.0, 101.0, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    FabricFactors factors;
    factors.bending = factor;
    try {
      scaledBy(factors, wool());
      FAIL() << "accepted: " << factor;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).find("the factor of bending = "), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace haptex::material::test_fabric_factors
