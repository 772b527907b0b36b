#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "haptex/nodes/rviz_plugin/colour_scale.h"

namespace haptex::nodes::test_colour_scale {
namespace {

TEST(ColourScale, EveryTickLiesWhereItsValueIs) {
  const ColourScale scale = scaleOf(ColourBy::kStress);  // 0.01 to 100 N/m
  const std::vector<ScaleTick> ticks = scale.ticks();
  ASSERT_EQ(ticks.size(), 5u);
  EXPECT_EQ(ticks.front().label, "0.01");
  EXPECT_EQ(ticks.back().label, "100");
  for (const ScaleTick& tick : ticks) {
    EXPECT_NEAR(scale.fraction(std::stod(tick.label)), tick.fraction, 1e-12);
  }
}

TEST(ColourScale, StrainIsSaidInPerCent) {
  EXPECT_EQ(scaleOf(ColourBy::kStrain).ticks().back().label, "1 %");
}

TEST(ColourScale, WhatIsNotAboveZeroHasTheFirstColour) {
  const ColourScale scale = scaleOf(ColourBy::kStrain);
  for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(scale.fraction(value), 0.0);
  }
  EXPECT_EQ(scale.fraction(std::numeric_limits<double>::infinity()), 1.0);
}

TEST(ColourScale, FabricsAndPanelsHaveNone) {
  EXPECT_THROW(scaleOf(ColourBy::kFabric), std::invalid_argument);
  EXPECT_THROW(scaleOf(ColourBy::kPanel), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::nodes::test_colour_scale
