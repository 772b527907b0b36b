#include <gtest/gtest.h>

#include "fixtures.h"
#include "haptex/contact/held_fingertip.h"

namespace haptex::contact::test_held_fingertip {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 7.5e-3;
constexpr double kReach = kRadius + 0.2e-3;
constexpr double kCore = kReach - HeldFingertip::kDeepest * kRadius;

/// Particles 1 mm apart in the plane x = 0.
class HeldFingertipTest : public testing::Test {
 protected:
  HeldFingertipTest() {
    for (int i = -10; i <= 10; ++i) {
      for (int j = -10; j <= 10; ++j) positions_.push_back({0.0, 1e-3 * i, 1e-3 * j});
    }
    velocities_.assign(positions_.size(), Vector3d::Zero());
    areas_.assign(positions_.size(), 1e-6);
  }

  const Fingertip& moveTo(const Vector3d& place, double friction = 0.3) {
    Fingertip next;
    next.radius = kRadius;
    next.position = place;
    const Particles particles{positions_, velocities_, areas_, static_cast<int>(positions_.size())};
    const Fingertip& held = finger_.move(next, particles, contact_.touched(), kReach, friction);
    contact_.commit(particles, held);
    return held;
  }

  std::vector<Vector3d> positions_, velocities_;
  std::vector<double> areas_;
  const ContactLaw law_{wool()};
  SphereContact contact_{law_, 441};
  HeldFingertip finger_;
};

TEST_F(HeldFingertipTest, IsWhereThePersonHasItUntilItIsDeep) {
  for (const double x : {0.02, 0.008, 0.006, 0.004, 0.0028}) {
    EXPECT_EQ(moveTo({x, 0.0, 0.0}).position.x(), x);
    EXPECT_FALSE(finger_.isHeld());
  }
}

TEST_F(HeldFingertipTest, StopsAtTwoMetresPerSecondUntilItIsPulledBack) {
  for (int tick = 0; tick <= 30; ++tick) {
    const double x = moveTo({0.02 - 2e-3 * tick, 0.0, 0.0}).position.x();
    EXPECT_GE(x, kCore - 1e-9) << tick;
  }
  EXPECT_TRUE(finger_.isHeld());
  EXPECT_NEAR(moveTo({0.002, 0.0, 0.0}).position.x(), kCore, 1e-9);
  EXPECT_EQ(moveTo({0.004, 0.0, 0.0}).position.x(), 0.004);
  EXPECT_FALSE(finger_.isHeld());
}

TEST_F(HeldFingertipTest, StopsHoweverFarItJumps) {
  moveTo({0.02, 0.0, 0.0});
  EXPECT_NEAR(moveTo({-0.05, 0.0, 0.0}).position.x(), kCore, 1e-9);
}

TEST_F(HeldFingertipTest, LetsGoWhenItIsTooFarAway) {
  moveTo({0.02, 0.0, 0.0});
  EXPECT_EQ(moveTo({0.019 - HeldFingertip::kLongest, 0.0, 0.0}).position.x(),
            0.019 - HeldFingertip::kLongest);
  EXPECT_FALSE(finger_.isHeld());
}

TEST_F(HeldFingertipTest, GoesBackWithClothThatComesBack) {
  moveTo({0.02, 0.0, 0.0});
  moveTo({0.0, 0.0, 0.0});
  for (Vector3d& place : positions_) place.x() += 1e-3;
  EXPECT_NEAR(moveTo({0.0, 0.0, 0.0}).position.x(), kCore + 1e-3, 1e-9);
  EXPECT_TRUE(finger_.isHeld());
}

TEST_F(HeldFingertipTest, ClothThatComesBackDoesNotPassOneAtRest) {
  moveTo({0.0028, 0.0, 0.0});
  for (int tick = 0; tick < 20; ++tick) {
    for (Vector3d& place : positions_) place.x() += 1e-3;
    EXPECT_GT(moveTo({0.0028, 0.0, 0.0}).position.x(), positions_.front().x());
  }
}

TEST_F(HeldFingertipTest, FrictionHoldsItAsideToo) {
  moveTo({0.02, 0.0, 0.0});
  moveTo({-0.02, 0.0, 0.0});
  const Vector3d stopped = finger_.held()->position;
  EXPECT_LT((moveTo({-0.02, 0.005, 0.0}).position - stopped).norm(), 1e-9);
  EXPECT_GT(moveTo({-0.002, 0.005, 0.0}, 0.1).position.y(), 1e-4);
}

TEST_F(HeldFingertipTest, LooksForClothOnTheWayFromAnEarlierPlace) {
  Fingertip through;
  through.radius = kRadius;
  through.position = {-0.02, 0.0, 0.0};
  finger_.follow(through);
  finger_.sweepFrom(Vector3d(0.02, 0.0, 0.0));
  EXPECT_NEAR(moveTo({-0.022, 0.0, 0.0}).position.x(), kCore, 1e-9);
}

}  // namespace
}  // namespace haptex::contact::test_held_fingertip
