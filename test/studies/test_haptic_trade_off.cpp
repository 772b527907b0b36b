#include <gtest/gtest.h>

#include <limits>

#include "haptex/base/workload.h"
#include "haptex/material/fabric_file.h"
#include "haptex/studies/haptic_trade_off.h"

namespace haptex::studies::test_haptic_trade_off {
namespace {

/// The press into the taut wool sample, and a little of the rest after it.
oracles::PrescribedTouch makeShortPress() {
  const auto fabric = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  oracles::PrescribedTouch press = oracles::prescribedTouches(fabric).at(0);
  press.duration = 0.18;
  return press;
}

const oracles::PrescribedTouch& shortPress() {
  static const oracles::PrescribedTouch press = makeShortPress();
  return press;
}

/// On cells that are a little finer than those of refinement 1.
const TouchReference& reference() {
  static const TouchReference reference = computeReference(shortPress(), 2.5e-3, 2);
  return reference;
}

HapticPoint point(int refinement, double large_scale_step = 4e-3) {
  HapticPoint point;
  point.haptics.refinement = refinement;
  point.large_scale_step = large_scale_step;
  return point;
}

TEST(HapticTradeOff, FinerIsNearerToTheReferenceAndHasMoreParticles) {
  if (base::kSanitized) GTEST_SKIP() << "the tests below run the same code";
  constexpr double kStep = 1e-3;  // s: loads of no age, whose error no refinement mends
  const HapticCost coarse = measureTouch(shortPress(), point(0, kStep), reference());
  const HapticCost fine = measureTouch(shortPress(), point(1, kStep), reference());
  EXPECT_GT(coarse.force_error, 2.0 * fine.force_error);
  EXPECT_LT(fine.force_error, 0.2 * reference().force);
  EXPECT_GT(fine.particles, 2 * coarse.particles);
  EXPECT_EQ(coarse.rejected_steps, 0);
  EXPECT_EQ(fine.rejected_steps, 0);
}

TEST(HapticTradeOff, ErrorsRepeatBitForBitAndWorstOnesAreAtLeastMeanOnes) {
  const HapticCost once = measureTouch(shortPress(), point(1), reference());
  const HapticCost again = measureTouch(shortPress(), point(1), reference());
  EXPECT_EQ(once.force_error, again.force_error);
  EXPECT_EQ(once.worst_error, again.worst_error);
  EXPECT_EQ(once.rest_error, again.rest_error);
  EXPECT_GT(once.force_error, 0.0);
  EXPECT_GE(once.worst_error, once.force_error);
  EXPECT_GE(once.worst_error, once.rest_error);
  EXPECT_GT(once.tick_time, 0.0);
  EXPECT_GT(once.large_scale_time, 0.0);
  EXPECT_DOUBLE_EQ(once.forceLoopTime(point(1)), once.tick_time / 1e-3);
}

TEST(HapticTradeOff, TheReferenceIsNearerToItsLimitThanItsForce) {
  EXPECT_GT(reference().force, 0.0);
  EXPECT_LT(reference().error, 0.1 * reference().force);
  EXPECT_GE(reference().worst_error, reference().error);
}

TEST(HapticTradeOff, StepsThatDoNotFitAreRefused) {
  HapticPoint odd = point(1);
  odd.haptics.time_step = 7e-4;
  EXPECT_THROW(measureTouch(shortPress(), odd, reference()), std::invalid_argument);
  odd = point(1);
  odd.large_scale_step = 0.0125;
  EXPECT_THROW(measureTouch(shortPress(), odd, reference()), std::invalid_argument);
  odd.large_scale_step = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(measureTouch(shortPress(), odd, reference()), std::invalid_argument);
  oracles::PrescribedTouch longer = shortPress();
  longer.duration = 0.192;
  EXPECT_THROW(measureTouch(longer, point(1), reference()), std::invalid_argument);
  EXPECT_THROW(computeReference(shortPress(), 6e-3, 3), std::invalid_argument);
}

TEST(HapticTradeOff, WhatAnotherBeatsIsNotOnTheFront) {
  const std::vector<ErrorAndTime> points = {{1.0, 3.0}, {2.0, 2.0}, {2.0, 3.0},
                                            {3.0, 1.0}, {2.0, 2.0}, {3.0, 2.0}};
  EXPECT_EQ(isDominated(points), (std::vector<char>{0, 0, 1, 0, 0, 1}));
}

}  // namespace
}  // namespace haptex::studies::test_haptic_trade_off
