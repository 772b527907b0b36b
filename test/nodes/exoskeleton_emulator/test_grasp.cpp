#include <gtest/gtest.h>

#include "haptex/nodes/exoskeleton_emulator/grasp.h"

namespace haptex::nodes::test_grasp {
namespace {

using base::Finger;

Grasp::Fingertips openFingertips() {
  Grasp::Fingertips fingertips;
  fingertips[Finger::kIndex] = {0.09, 0.03, -0.05};
  fingertips[Finger::kThumb] = {0.05, 0.03, -0.09};
  return fingertips;
}

Eigen::Vector3d middleOf(const Grasp::Fingertips& fingertips) {
  return 0.5 * (fingertips[Finger::kIndex] + fingertips[Finger::kThumb]);
}

/// Follows the grasp to its end. @returns s that it took
double finish(Grasp& grasp, Grasp::Fingertips& fingertips) {
  constexpr double kPeriod = 0.01;
  double time = 0.0;
  while (const auto moved = grasp.after(kPeriod, fingertips)) {
    EXPECT_LE(std::abs(Grasp::distanceOf(*moved) - Grasp::distanceOf(fingertips)),
              Grasp::kSpeed * kPeriod + 1e-12);
    fingertips = *moved;
    time += kPeriod;
    if (time > 60.0) break;
  }
  return time;
}

TEST(Grasp, ClosesAtItsSpeedAroundTheMiddleAndOpensToWhereItWas) {
  Grasp grasp;
  Grasp::Fingertips fingertips = openFingertips();
  const double opened = Grasp::distanceOf(fingertips);
  grasp.close(fingertips);
  EXPECT_NEAR(finish(grasp, fingertips), (opened - Grasp::kClosed) / Grasp::kSpeed, 0.011);
  EXPECT_NEAR(Grasp::distanceOf(fingertips), Grasp::kClosed, 2e-6);
  EXPECT_LT((middleOf(fingertips) - middleOf(openFingertips())).norm(), 1e-12);
  EXPECT_TRUE(grasp.open());
  finish(grasp, fingertips);
  EXPECT_NEAR(Grasp::distanceOf(fingertips), opened, 2e-6);
}

TEST(Grasp, OpensOnlyWhatItHasClosed) {
  Grasp grasp;
  EXPECT_FALSE(grasp.open());
  EXPECT_FALSE(grasp.after(0.01, openFingertips()));
}

TEST(Grasp, ClosingTwiceOpensToWhereItWasFirst) {
  Grasp grasp;
  Grasp::Fingertips fingertips = openFingertips();
  const double opened = Grasp::distanceOf(fingertips);
  grasp.close(fingertips);
  finish(grasp, fingertips);
  grasp.close(fingertips);
  EXPECT_TRUE(grasp.open());
  finish(grasp, fingertips);
  EXPECT_NEAR(Grasp::distanceOf(fingertips), opened, 2e-6);
}

TEST(Grasp, EndsWhenSomebodyElseMovesTheFingertips) {
  Grasp grasp;
  grasp.close(openFingertips());
  grasp.end();
  EXPECT_FALSE(grasp.after(0.01, openFingertips()));
}

TEST(Grasp, DistancesAreLimited) {
  const Grasp::Fingertips fingertips = openFingertips();
  EXPECT_NEAR(Grasp::distanceOf(Grasp::atDistance(0.0, fingertips)), Grasp::kClosed, 1e-12);
  EXPECT_NEAR(Grasp::distanceOf(Grasp::atDistance(1.0, fingertips)), Grasp::kFarthest, 1e-12);
  Grasp::Fingertips together = fingertips;
  together[Finger::kThumb] = together[Finger::kIndex];
  EXPECT_EQ(Grasp::distanceOf(Grasp::atDistance(0.05, together)), 0.0) << "there is no direction";
}

}  // namespace
}  // namespace haptex::nodes::test_grasp
