#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "haptex/exoskeleton/control/homing.h"

namespace haptex::exoskeleton::test_homing {
namespace {

using std::chrono::milliseconds;
using Status = Homing::Status;

/// Three motors with inertia and friction between stiff stops.
struct Motors {
  static constexpr double kInertia = 2e-7, kViscous = 8e-6, kCoulomb = 1.2e-4, kStop = 1.0;
  MotorVector lower{-3.0, 2.0, -7.0};
  MotorVector range{6.0, 10.0, 8.0};
  MotorVector angles = lower + 0.5 * range;
  MotorVector velocities = MotorVector::Zero();
  MotorVector load = MotorVector::Zero();  ///< N m, for example of gravity
  int jammed = -1, shaken = -1;
  Time now{milliseconds(3)};
  double largest_torque = 0.0, fastest = 0.0;

  void step(const MotorVector& torques) {
    if (shaken >= 0) load[shaken] = 4e-3 * std::sin(40.0 * seconds(now));
    largest_torque = std::max(largest_torque, torques.cwiseAbs().maxCoeff());
    for (int substep = 0; substep < 8; ++substep) {
      for (int i = 0; i < kMotors; ++i) {
        if (i == jammed) continue;
        double torque = torques[i] + load[i] + kStop * std::max(0.0, lower[i] - angles[i]) -
                        kStop * std::max(0.0, angles[i] - lower[i] - range[i]);
        const bool in_stop = angles[i] < lower[i] || angles[i] > lower[i] + range[i];
        torque -= (kViscous + (in_stop ? 3e-4 : 0.0)) * velocities[i];
        const double dt = 1.0 / 8000.0;
        const double friction = dt * kCoulomb / kInertia;
        const double free = velocities[i] + dt * torque / kInertia;
        velocities[i] = std::abs(free) <= friction ? 0.0 : free - std::copysign(friction, free);
        angles[i] += dt * velocities[i];
      }
    }
    fastest = std::max(fastest, velocities.cwiseAbs().maxCoeff());
  }

  Status home(Homing& homing) {
    homing.start(range, now);
    const Time start = now;
    while (homing.status() == Status::kRunning && now - start < std::chrono::seconds(20)) {
      now += milliseconds(1);
      step(homing.tick(angles, velocities, now));
    }
    return homing.status();
  }
};

TEST(Homing, FindsTheLowerStopsGently) {
  Motors motors;
  Homing homing;
  ASSERT_EQ(motors.home(homing), Status::kDone);
  EXPECT_EQ(homing.culprit(), -1);
  // A count of the encoder is 3 mrad.
  EXPECT_LT((motors.angles - motors.lower).cwiseAbs().maxCoeff(), 0.003);
  EXPECT_LE(motors.largest_torque, Homing::kTorque);
  EXPECT_LE(motors.fastest, 1.2 * Homing::kSpeed);
  EXPECT_LT(motors.now, std::chrono::seconds(6));
}

TEST(Homing, OvercomesTheWeightOfTheLinks) {
  for (const double weight : {-6e-4, 6e-4}) {
    Motors motors;
    Homing homing;
    motors.load.setConstant(weight);
    EXPECT_EQ(motors.home(homing), Status::kDone) << weight;
    EXPECT_LT((motors.angles - motors.lower).cwiseAbs().maxCoeff(), 0.003) << weight;
  }
}

TEST(Homing, StartsFromAStopAsWell) {
  Motors motors;
  motors.angles = motors.lower;
  Homing homing;
  EXPECT_EQ(motors.home(homing), Status::kDone);
}

TEST(Homing, NamesAMotorThatDoesNotLeaveItsStop) {
  Motors motors;
  motors.jammed = 1;  // or its encoder is dead
  Homing homing;
  EXPECT_EQ(motors.home(homing), Status::kStuck);
  EXPECT_EQ(homing.culprit(), 1);
}

TEST(Homing, NamesAMotorThatSomebodyHoldsElsewhere) {
  Motors motors;
  motors.load[2] = 2e-3;
  Homing homing;
  EXPECT_EQ(motors.home(homing), Status::kStuck);
  EXPECT_EQ(homing.culprit(), 2);
}

TEST(Homing, NamesAMotorThatFindsNoRestInTime) {
  Motors motors;
  motors.shaken = 2;
  Homing homing;
  const Time start = motors.now;
  EXPECT_EQ(motors.home(homing), Status::kNoRest);
  EXPECT_EQ(homing.culprit(), 2);
  EXPECT_GT(motors.now - start, Homing::kTimeout);
  EXPECT_LT(motors.now - start, Homing::kTimeout + milliseconds(10));
}

TEST(Homing, NamesAMotorThatTurnsTooFar) {
  Motors motors;
  Homing homing;
  motors.lower[0] = -1000.0;  // no stop: the transmission slips
  EXPECT_EQ(motors.home(homing), Status::kTurnedTooFar);
  EXPECT_EQ(homing.culprit(), 0);
}

TEST(Homing, NamesAMotorThatFindsAnotherStopTheSecondTime) {
  Motors motors;
  Homing homing;
  homing.start(motors.range, motors.now);
  bool touched = false;
  while (homing.status() == Status::kRunning) {
    motors.now += milliseconds(1);
    const MotorVector torques = homing.tick(motors.angles, motors.velocities, motors.now);
    if (!touched && torques.minCoeff() > 0.0) {
      touched = true;
      motors.lower[1] += 0.02;
    }
    motors.step(torques);
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(homing.status(), Status::kDifferentPlace);
  EXPECT_EQ(homing.culprit(), 1);
}

TEST(Homing, GivesNoTorqueUnlessItRuns) {
  Homing homing;
  const MotorVector zero = MotorVector::Zero();
  EXPECT_EQ(homing.tick(MotorVector::Ones(), zero, milliseconds(1)), zero);
  Motors motors;
  ASSERT_EQ(motors.home(homing), Status::kDone);
  EXPECT_EQ(homing.tick(motors.angles, zero, motors.now + milliseconds(1)), zero);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_homing
