#include <gtest/gtest.h>

#include <cmath>

#include "haptex/contact/carry/carried_load.h"

namespace haptex::contact::test_carried_load {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPeriod = 0.02;  // s
const std::vector<Vector3d> kPlace(3, Vector3d(0.1, 0.2, 0.3));

class CarriedLoadTest : public testing::Test {
 protected:
  CarriedLoadTest() { motion_.receive(kPlace, kPeriod); }

  /// Loads of 0.3 N, at places that the cloth will be `by` off.
  void send(const Vector3d& by, double gain = 1.0) {
    const cloth::PointLoad load{0, Vector3d(0.2, 0.3, 0.5), kPlace[0] - by,
                                Vector3d(0.0, 0.0, 0.15), 1000.0 * Matrix3d::Identity()};
    carried_.send({load, load}, gain);
  }

  void receive() {
    motion_.receive(kPlace, kPeriod);
    carried_.receive(motion_);
  }

  LargeScaleMotion motion_{3};
  CarriedLoad carried_{{{0, 1, 2}}};
};

TEST_F(CarriedLoadTest, IsWhatWasSentWhereTheClothIsWhereItWasFelt) {
  send(Vector3d::Zero());
  receive();
  EXPECT_NEAR(carried_.now(motion_).force.norm(), 0.0, 1e-15) << "jumps";
  motion_.advance(0.5 * kPeriod);
  EXPECT_TRUE(carried_.now(motion_).force.isApprox(Vector3d(0.0, 0.0, 0.15), 1e-12));
  motion_.advance(kPeriod);
  EXPECT_TRUE(carried_.now(motion_).force.isApprox(Vector3d(0.0, 0.0, 0.3), 1e-12));
}

TEST_F(CarriedLoadTest, HasTheShareThatActs) {
  send(Vector3d::Zero(), 0.5);
  receive();
  motion_.advance(kPeriod);
  EXPECT_TRUE(carried_.now(motion_).force.isApprox(Vector3d(0.0, 0.0, 0.15), 1e-12));
}

TEST_F(CarriedLoadTest, TakesAFewMilliNewtonOfTheStiffnessAtOnceAndAllOfItInTime) {
  const Vector3d off(1e-5, 0.0, 0.0);  // which is 0.02 N
  for (int state = 0; state < 100; ++state) {
    send(off);
    receive();
    motion_.advance(kPeriod);
    const double slow = -carried_.now(motion_).force.x();
    EXPECT_NEAR(slow, 0.02 * (1.0 - std::pow(0.1 / (0.1 + kPeriod), state + 1)), 1e-12) << state;
  }
}

TEST_F(CarriedLoadTest, IsNeverMoreThan50mNOffWhatWasSent) {
  for (int state = 0; state < 100; ++state) {
    send(Vector3d(0.0, 0.01, 0.0));
    receive();
    motion_.advance(kPeriod);
    EXPECT_LT((carried_.now(motion_).force - Vector3d(0.0, 0.0, 0.3)).norm(), 0.05 + 1e-12);
  }
}

TEST_F(CarriedLoadTest, IsNoneWhereNoneWasSent) {
  send(Vector3d(0.0, 0.01, 0.0));
  receive();
  receive();
  motion_.advance(kPeriod);
  EXPECT_EQ(carried_.now(motion_).force, Vector3d::Zero());
}

TEST_F(CarriedLoadTest, KnowsHowFastTheClothIsThere) {
  send(Vector3d::Zero());
  std::vector<Vector3d> moved = kPlace;
  for (Vector3d& place : moved) place.x() += 1e-3;
  motion_.receive(moved, kPeriod);
  carried_.receive(motion_);
  EXPECT_TRUE(carried_.now(motion_).velocity.isApprox(Vector3d(0.05, 0.0, 0.0), 1e-9));
}

}  // namespace
}  // namespace haptex::contact::test_carried_load
