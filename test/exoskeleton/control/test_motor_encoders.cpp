#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/exoskeleton/control/motor_encoders.h"

namespace haptex::exoskeleton::test_motor_encoders {
namespace {

using Counts = std::array<std::int32_t, kMotors>;

constexpr double kCount = 2.0 * M_PI / kCountsPerRevolution;  // rad
constexpr double kPeriod = 0.001;                             // s

/// Counts of a motor that turns at this speed (rad/s) at this time (s).
std::int32_t countsAt(double speed, double time) {
  return static_cast<std::int32_t>(std::lround(speed * time / kCount));
}

TEST(MotorEncoders, AreWhereTheyWereCalibratedPlusTheCounts) {
  MotorEncoders encoders;
  EXPECT_TRUE(encoders.update({100, 200, -300}, kPeriod));
  encoders.calibrate({0.5, -1.0, 2.0});
  EXPECT_EQ(encoders.angles(), MotorVector(0.5, -1.0, 2.0));
  EXPECT_TRUE(encoders.update({101, 198, -290}, kPeriod));
  const MotorVector expected(0.5 + kCount, -1.0 - 2 * kCount, 2.0 + 10 * kCount);
  EXPECT_TRUE(encoders.angles().isApprox(expected, 1e-15));
}

TEST(MotorEncoders, CountOnAcrossTheWrapAround) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  MotorEncoders encoders;
  EXPECT_TRUE(encoders.update({kMost - 1, kLeast + 1, 0}, kPeriod));
  encoders.calibrate(MotorVector::Zero());
  EXPECT_TRUE(encoders.update({kLeast + 1, kMost - 1, 0}, kPeriod));
  EXPECT_TRUE(encoders.angles().isApprox(MotorVector(3 * kCount, -3 * kCount, 0.0), 1e-15));
}

TEST(MotorEncoders, RefuseWhatNoMotorCanDo) {
  MotorEncoders encoders;
  EXPECT_TRUE(encoders.update({0, 0, 0}, kPeriod));
  const int most = static_cast<int>(MotorEncoders::kMaxSpeed * kPeriod / kCount);
  EXPECT_TRUE(encoders.update({most, 0, 0}, kPeriod));
  const MotorVector angles = encoders.angles(), velocities = encoders.velocities();
  EXPECT_FALSE(encoders.update({most, 0, most + 2}, kPeriod));
  EXPECT_EQ(encoders.angles(), angles);
  EXPECT_EQ(encoders.velocities(), velocities);
  EXPECT_TRUE(encoders.update({most, 0, most + 2}, 2 * kPeriod)) << "slower, because later";
}

TEST(MotorEncoders, RestartTakesAnyCounts) {
  MotorEncoders encoders;
  encoders.update({0, 0, 0}, kPeriod);
  encoders.calibrate({1.0, 2.0, 3.0});
  encoders.update({50, 50, 50}, kPeriod);
  const MotorVector angles = encoders.angles();
  encoders.restart();
  EXPECT_EQ(encoders.velocities(), MotorVector::Zero());
  EXPECT_TRUE(encoders.update({1000000, -1000000, 7}, kPeriod));
  EXPECT_EQ(encoders.angles(), angles);
  EXPECT_TRUE(encoders.update({1000001, -1000000, 7}, kPeriod));
  EXPECT_NEAR(encoders.angles()[0], angles[0] + kCount, 1e-12);
}

TEST(MotorEncoders, AReadingAtTheSameTimeChangesNothing) {
  MotorEncoders encoders;
  encoders.update({0, 0, 0}, kPeriod);
  EXPECT_TRUE(encoders.update({100000, 0, 0}, 0.0));
  EXPECT_EQ(encoders.angles(), MotorVector::Zero());
  EXPECT_TRUE(encoders.velocities().allFinite());
}

TEST(MotorEncoders, VelocityIsThatOfTheMotorAfterItsDelay) {
  // Of a speed that rises by 1000 rad/s^2 the estimate is behind by the delay times that.
  MotorEncoders encoders;
  double time = 0.0, late = 0.0;
  int n = 0;
  for (; time < 0.2; time += kPeriod) {
    const std::int32_t counts =
        static_cast<std::int32_t>(std::lround(500.0 * time * time / kCount));
    encoders.update({counts, 0, 0}, kPeriod);
    if (time < 0.05) continue;
    late += (1000.0 * time - encoders.velocities()[0]) / 1000.0;
    ++n;
  }
  EXPECT_NEAR(late / n, 0.0049, 0.0001);
}

TEST(MotorEncoders, QuantisationMakesNoMoreNoiseThanPromised) {
  MotorEncoders encoders;
  double largest = 0.0;
  encoders.update({0, 0, 0}, kPeriod);
  for (int i = 0; i < 100; ++i) {
    encoders.update({1, 0, 0}, kPeriod);  // a single count
    largest = std::max(largest, encoders.velocities()[0]);
  }
  EXPECT_LE(largest, 0.43);
  EXPECT_GT(largest, 0.3);
  const double speed = 0.7;  // rad/s, a count every 4.4 periods
  for (int i = 0; i < 1000; ++i) {
    encoders.update({1 + countsAt(speed, i * kPeriod), 0, 0}, kPeriod);
    if (i > 100) {
      EXPECT_NEAR(encoders.velocities()[0], speed, 0.43);
    }
  }
}

TEST(MotorEncoders, LostReadingsDoNotDisturbTheVelocity) {
  MotorEncoders encoders;
  double time = 0.0;
  int i = 0;
  while (time < 0.5) {
    const double dt = (++i % 7 == 0) ? 5 * kPeriod : kPeriod;
    time += dt;
    encoders.update({countsAt(100.0, time), 0, 0}, dt);
    if (time > 0.1) {
      EXPECT_NEAR(encoders.velocities()[0], 100.0, 1.0);
    }
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_motor_encoders
