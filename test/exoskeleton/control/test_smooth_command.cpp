#include <gtest/gtest.h>

#include <cmath>

#include "haptex/exoskeleton/control/safety_chain.h"
#include "haptex/exoskeleton/control/smooth_command.h"

namespace haptex::exoskeleton::test_smooth_command {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Vector3d kZero = Vector3d::Zero();

ForceCommand constant(const Vector3d& force) {
  ForceCommand command;
  command.force = force;
  return command;
}

/// A spring of 500 N/m at `rest`, linearised at p.
ForceCommand spring(const Vector3d& rest, const Vector3d& p) {
  ForceCommand command;
  command.stiffness = 500.0 * Matrix3d::Identity();
  command.force = 500.0 * (rest - p);
  command.position = p;
  return command;
}

/// What two filters of kSmoothing make of a step of 1, i periods after it.
double stepResponse(int i) {
  const double left = std::exp(-SmoothCommand::kPeriod / SmoothCommand::kSmoothing);
  double first = 0.0, second = 0.0;
  for (int j = 0; j < i; ++j) {
    first += (1.0 - left) * (1.0 - first);
    second += (1.0 - left) * (first - second);
  }
  return second;
}

TEST(SmoothCommand, AStepBecomesTheStepResponseOfTwoFilters) {
  SmoothCommand smooth;
  smooth.receive(constant({2.0, 0.0, -1.0}), kZero, kZero);
  for (int i = 1; i <= 60; ++i) {
    const Vector3d force = smooth.tick(kZero, kZero);
    EXPECT_LT((force - stepResponse(i) * Vector3d(2.0, 0.0, -1.0)).norm(), 1e-12) << i;
  }
  smooth.receive(constant({0.0, 3.0, 0.0}), kZero, kZero);
  const Vector3d force = smooth.tick(kZero, kZero);
  EXPECT_NEAR(force.y(), 3.0 * stepResponse(1), 1e-6);
  EXPECT_NEAR(force.x(), 2.0 - 2.0 * stepResponse(1), 1e-5);
}

TEST(SmoothCommand, GoesOnFromWhatWasRendered) {
  SmoothCommand smooth;
  smooth.receive(constant({2.0, 0.0, 0.0}), kZero, kZero);
  smooth.tick(kZero, kZero);
  smooth.receiveFrom({0.5, 0.0, 0.0}, constant({2.0, 1.0, 0.0}), kZero, kZero);
  for (int i = 1; i <= 60; ++i) {
    const Vector3d expected = Vector3d(0.5, 0.0, 0.0) + stepResponse(i) * Vector3d(1.5, 1.0, 0.0);
    EXPECT_LT((smooth.tick(kZero, kZero) - expected).norm(), 1e-12) << i;
  }
}

TEST(SmoothCommand, TheForceOfAPlaceIsNotLate) {
  SmoothCommand smooth;
  const Vector3d rest(0.1, 0.0, 0.0);
  Vector3d p(0.1, 0.0, 0.0);
  smooth.receive(spring(rest, p), p, kZero);
  for (int i = 0; i < 200; ++i) {
    p.x() = 0.1 + 0.005 * std::sin(0.3 * i);
    // The same spring, linearised anew where the finger is or was.
    if (i % 3 == 0) smooth.receive(spring(rest, p - Vector3d(0.001, 0.0, 0.0)), p, kZero);
    EXPECT_LT((smooth.tick(p, kZero) - 500.0 * (rest - p)).norm(), 1e-9);
  }
}

TEST(SmoothCommand, BeginsSoftlyAfterARest) {
  SmoothCommand smooth;
  const ForceCommand command = constant({4.0, 0.0, 0.0});
  smooth.receive(command, kZero, kZero);
  for (int i = 0; i < 100; ++i) smooth.tick(kZero, kZero);
  smooth.rest();
  smooth.receive(command, kZero, kZero);
  EXPECT_NEAR(smooth.tick(kZero, kZero).x(), 4.0 * stepResponse(1), 1e-12);
}

TEST(SmoothCommand, ForcesBeyondTheDeviceCountAsItsLargest) {
  SmoothCommand smooth;
  smooth.receive(constant({1e300, 0.0, 0.0}), kZero, kZero);
  for (int i = 0; i < 200; ++i) smooth.tick(kZero, kZero);
  EXPECT_TRUE(smooth.saturated());
  EXPECT_NEAR(smooth.tick(kZero, kZero).x(), kMaxForce, 1e-9);
  smooth.receive(constant({1.0, 0.0, 0.0}), kZero, kZero);
  EXPECT_NEAR(smooth.tick(kZero, kZero).x(), kMaxForce - 4.0 * stepResponse(1), 1e-9);
  EXPECT_FALSE(smooth.saturated());
}

TEST(SmoothCommand, RecoversFromACommandThatOverflows) {
  SmoothCommand smooth;
  ForceCommand overflowing = constant({1.0, 0.0, 0.0});
  overflowing.stiffness.setConstant(1e308);
  overflowing.position.setConstant(1e300);
  smooth.receive(constant({1.0, 0.0, 0.0}), kZero, kZero);
  smooth.tick(kZero, kZero);
  smooth.receive(overflowing, kZero, kZero);
  EXPECT_FALSE(smooth.tick(kZero, kZero).allFinite());
  smooth.receive(constant({1.0, 0.0, 0.0}), kZero, kZero);
  EXPECT_NEAR(smooth.tick(kZero, kZero).x(), stepResponse(1), 1e-12);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_smooth_command
