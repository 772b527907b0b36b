#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "haptex/exoskeleton/control/passivity_controller.h"

namespace haptex::exoskeleton::test_passivity_controller {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 0.001;  // s

/// A mass on a virtual spring whose force is `delay` periods old: such a spring gives energy.
/// @returns largest excursion (m) in the last of three seconds
double swing(int delay, bool controlled) {
  constexpr double kMass = 0.05, kStiffness = 300.0;
  PassivityController passivity;
  double x = 0.005, v = 0.0, largest = 0.0;
  std::vector<double> past(static_cast<std::size_t>(delay) + 1, x);
  Vector3d rendered = Vector3d::Zero();
  for (int i = 0; i < 3000; ++i) {
    const Vector3d velocity(v, 0.0, 0.0);
    const Vector3d wanted(-kStiffness * past.front(), 0.0, 0.0);
    passivity.observe(rendered, velocity, kPeriod);
    rendered = controlled ? passivity.apply(wanted, velocity, kPeriod) : wanted;
    v += kPeriod * rendered.x() / kMass;
    x += kPeriod * v;
    if (!(std::abs(x) < 10.0)) return 10.0;
    past.erase(past.begin());
    past.push_back(x);
    if (i > 2000) largest = std::max(largest, std::abs(x));
  }
  return largest;
}

TEST(PassivityController, AddsUpWhatTheObjectAbsorbs) {
  PassivityController passivity;
  passivity.observe({2.0, 1.0, 0.0}, {-0.1, 0.0, 5.0}, 0.01);
  EXPECT_NEAR(passivity.energy(), 0.002, 1e-15);
  passivity.observe({2.0, 1.0, 0.0}, {0.0, 0.1, 0.0}, 0.01);
  EXPECT_NEAR(passivity.energy(), 0.001, 1e-15);
  passivity.reset();
  EXPECT_EQ(passivity.energy(), 0.0);
}

TEST(PassivityController, RemembersNeitherCreditNorDebtWithoutLimit) {
  PassivityController passivity;
  passivity.observe({5.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 1.0);
  EXPECT_EQ(passivity.energy(), PassivityController::kMaxCredit);
  passivity.observe({5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0);
  EXPECT_EQ(passivity.energy(), -PassivityController::kMaxDebt);
}

TEST(PassivityController, DoesNothingWhileTheObjectIsPassive) {
  PassivityController passivity;
  passivity.observe({1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.01);
  const Vector3d force(1.0, 2.0, 3.0);
  EXPECT_EQ(passivity.apply(force, {1.0, 0.0, 0.0}, kPeriod), force);
  EXPECT_EQ(passivity.damping(), 0.0);
}

TEST(PassivityController, AddsTheSmallestDampingThatKeepsTheObjectPassive) {
  PassivityController passivity;
  passivity.observe({1.0, 0.0, 0.0}, {-0.5, 0.0, 0.0}, kPeriod);  // 0.5 mJ of credit
  const Vector3d velocity(1.0, 0.0, 0.0);
  const Vector3d force = passivity.apply({1.5, 0.5, 0.0}, velocity, kPeriod);
  EXPECT_NEAR(passivity.damping(), 1.0, 1e-12);
  EXPECT_TRUE(force.isApprox(Vector3d(0.5, 0.5, 0.0), 1e-12));
  passivity.observe(force, velocity, kPeriod);
  EXPECT_NEAR(passivity.energy(), 0.0, 1e-15);
}

TEST(PassivityController, DampingIsBoundedAndNeverMoreThanTheForce) {
  PassivityController passivity;
  passivity.observe({5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0);
  passivity.apply({5.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, kPeriod);
  EXPECT_EQ(passivity.damping(), PassivityController::kMaxDamping);
  EXPECT_TRUE(passivity.apply({0.2, 0.0, 0.0}, {1.0, 0.0, 0.0}, kPeriod).isZero(1e-15));
  EXPECT_EQ(passivity.apply({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, kPeriod), Vector3d::Zero());
}

TEST(PassivityController, DoesNotAmplifyTheNoiseOfAFingerAtRest) {
  PassivityController passivity;
  passivity.observe({5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0);
  const Vector3d force(3.0, 0.0, 0.0);
  EXPECT_EQ(passivity.apply(force, {0.004, 0.0, 0.0}, kPeriod), force);
  EXPECT_NE(passivity.apply(force, {0.006, 0.0, 0.0}, kPeriod), force);
  EXPECT_EQ(passivity.apply(force, {0.1, 0.0, 0.0}, 0.0), force) << "no time, no energy";
}

TEST(PassivityController, CalmsASpringThatLateForcesMakeUnstable) {
  EXPECT_GT(swing(5, false), 0.1) << "the spring is not unstable: the test tests nothing";
  EXPECT_LT(swing(5, true), 0.006);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_passivity_controller
