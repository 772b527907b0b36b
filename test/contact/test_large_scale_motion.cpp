#include <gtest/gtest.h>

#include "haptex/contact/large_scale_motion.h"

namespace haptex::contact::test_large_scale_motion {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d> kFirst = {{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
const std::vector<Vector3d> kSecond = {{1.0, 0.0, 0.0}, {1.0, 2.0, 5.0}};

TEST(LargeScaleMotion, HasNoStateAtFirstAndTakesTheFirstOneAtOnce) {
  LargeScaleMotion motion(2);
  EXPECT_FALSE(motion.hasState());
  motion.receive(kFirst, 0.02);
  EXPECT_TRUE(motion.hasState());
  EXPECT_EQ(motion.position(1), kFirst[1]);
}

TEST(LargeScaleMotion, GoesToTheNextStateInAStraightLineWithinItsPeriodAndWaitsThere) {
  LargeScaleMotion motion(2);
  motion.receive(kFirst, 0.02);
  motion.receive(kSecond, 0.04);
  EXPECT_EQ(motion.period(), 0.04);
  EXPECT_EQ(motion.position(1), kFirst[1]) << "jumps";
  motion.advance(0.01);
  EXPECT_TRUE(motion.position(1).isApprox(Vector3d(1.0, 2.0, 3.5), 1e-14));
  for (int i = 0; i < 30; ++i) motion.advance(0.001);
  EXPECT_TRUE(motion.position(0).isApprox(kSecond[0], 1e-13));
  motion.advance(1.0);
  EXPECT_EQ(motion.position(0), kSecond[0]);
}

TEST(LargeScaleMotion, AStateThatComesEarlyIsApproachedFromWhereItIs) {
  LargeScaleMotion motion(2);
  motion.receive(kFirst, 0.02);
  motion.receive(kSecond, 0.04);
  motion.advance(0.01);
  const Vector3d place = motion.position(0);
  motion.receive(kFirst, 0.02);
  EXPECT_TRUE(motion.position(0).isApprox(place, 1e-14));
  motion.advance(0.01);
  EXPECT_TRUE(motion.position(0).isApprox(0.5 * place, 1e-14));
}

}  // namespace
}  // namespace haptex::contact::test_large_scale_motion
