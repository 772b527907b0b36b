#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>

#include "controlled_device.h"
#include "haptex/exoskeleton/control/force_controller.h"

namespace haptex::exoskeleton::test_force_controller {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vector3d kZero = Vector3d::Zero();

/// m/rad, of a finger whose motors have levers of about 5 mm.
Matrix3d someJacobian() {
  Matrix3d jacobian;
  jacobian << 0.005, 0.001, 0.0, -0.001, 0.006, 0.002, 0.0, 0.0, 0.003;
  return jacobian;
}

ForceInput input(const Vector3d& desired, const Vector3d& measured) {
  ForceInput input;
  input.desired = desired;
  input.measured = measured;
  input.measured_now = input.sensor_works = true;
  input.jacobian = someJacobian();
  return input;
}

/// The force that these torques give at rest (N).
Vector3d forceOf(const MotorVector& torques) {
  return someJacobian().transpose().inverse() * torques;
}

/// A controller that for a second has measured what its torques give, three periods later.
ForceController settled(const Vector3d& force) {
  ForceController controller;
  Vector3d on_its_way[] = {kZero, kZero, kZero};
  for (int i = 0; i < 1000; ++i) {
    Vector3d& measured = on_its_way[i % 3];
    measured = forceOf(controller.tick(input(force, measured)));
  }
  return controller;
}

TEST(ForceController, FeedForwardIsTheTransposeOfTheJacobian) {
  const Vector3d force(1.0, -2.0, 0.5);
  ForceController controller = settled(force);
  const MotorVector torques = controller.tick(input(force, force));
  // What the integral took up during the step is little, and it is forgotten.
  EXPECT_LT((forceOf(torques) - force).norm(), 0.01);
}

TEST(ForceController, CorrectsWhatTheSensorMisses) {
  const Vector3d desired(1.0, 0.0, 0.0), missing(0.0, 0.2, -0.1);
  ForceController controller;
  Vector3d force = kZero;
  for (int i = 0; i < 1000; ++i) {
    force = forceOf(controller.tick(input(desired, force - missing)));
  }
  EXPECT_LT((force - missing - desired).norm(), 0.001);
  EXPECT_LT((controller.correction() - missing).norm(), 0.001);
}

TEST(ForceController, CorrectionIsBoundedHoweverWrongTheSensorIs) {
  ForceController controller;
  double largest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d wrong = 1e3 * Vector3d(std::sin(0.01 * i), std::cos(0.013 * i), 1.0);
    controller.tick(input(kZero, wrong));
    largest = std::max(largest, controller.correction().norm());
  }
  EXPECT_LE(largest, ForceController::kMaxCorrection + 1e-12);
  EXPECT_GT(largest, 0.9 * ForceController::kMaxCorrection);
}

TEST(ForceController, DoesNotWindUp) {
  ForceController controller = settled(kZero);
  for (int i = 0; i < 5000; ++i) controller.tick(input(kZero, {-3.0, 0.0, 0.0}));
  int ticks = 0;
  while (controller.correction().x() > 0.0 && ticks < 1000) {
    controller.tick(input(kZero, {3.0, 0.0, 0.0}));
    ++ticks;
  }
  // From the bound of 1 N back at 60 1/s times 3 N: 6 ms, and the filter of the error.
  EXPECT_LE(ticks, 25);
}

TEST(ForceController, WithoutAWorkingSensorItIsFeedForwardOnly) {
  const Vector3d desired(2.0, 0.0, 0.0);
  for (const bool saturated_sensor : {true, false}) {
    ForceController controller;
    for (int i = 0; i < 2000; ++i) controller.tick(input(desired, {1.7, 0.0, 0.0}));
    EXPECT_GT(controller.correction().norm(), 0.9);
    EXPECT_EQ(controller.feedForwardOnly(), 0u);
    ForceInput broken = input(desired, {10.0, 0.0, 0.0});
    if (saturated_sensor) {
      broken.sensor_works = false;
    } else {
      broken.measured.y() = kNan;
    }
    Vector3d force = kZero;
    for (int i = 0; i < 20; ++i) force = forceOf(controller.tick(broken));
    EXPECT_LT((force - desired).norm(), 1e-3);
    EXPECT_EQ(controller.feedForwardOnly(), 20u);
    for (int i = 0; i < 20; ++i) controller.tick(input(desired, desired));
    EXPECT_GT(controller.correction().norm(), 0.85) << "the integral was not frozen";
  }
}

TEST(ForceController, DoesNotLearnFromADeviceThatDoesNotObey) {
  ForceController controller = settled({1.0, 0.0, 0.0});
  ForceInput deaf = input({1.0, 0.0, 0.0}, kZero);
  deaf.obeyed = false;
  for (int i = 0; i < 500; ++i) controller.tick(deaf);
  EXPECT_EQ(controller.correction(), kZero);
  for (int i = 0; i < 30; ++i) controller.tick(input({1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
  EXPECT_LT(controller.correction().norm(), 0.01);
}

TEST(ForceController, WithoutANewMeasurementTheCorrectionStays) {
  ForceController controller;
  for (int i = 0; i < 300; ++i) controller.tick(input(kZero, {-0.01, 0.0, 0.0}));
  const Vector3d correction = controller.correction();
  ForceInput old = input(kZero, {-0.01, 0.0, 0.0});
  old.measured_now = false;
  for (int i = 0; i < 100; ++i) controller.tick(old);
  EXPECT_EQ(controller.correction(), correction);
}

TEST(ForceController, FollowsTheDesiredForceAtOnce) {
  ForceController controller = settled({5.0, 0.0, 0.0});
  for (const double left : {4.0, 3.0, 2.0, 1.0, 0.0}) {
    const Vector3d desired(left, 0.0, 0.0);
    const Vector3d force = forceOf(controller.tick(input(desired, {5.0, 0.0, 0.0})));
    EXPECT_LT((force - controller.correction() - desired).norm(), 0.05) << left;
  }
}

TEST(ForceController, ReleaseEndsEverythingWithinTenMillisecondsAndWithoutAJump) {
  ForceController controller;
  for (int i = 0; i < 2000; ++i) controller.tick(input({0.0, 0.0, 3.0}, kZero));
  Vector3d before = forceOf(controller.tick(input({0.0, 0.0, 3.0}, kZero)));
  EXPECT_NEAR(before.norm(), 4.0, 1e-3) << "no correction to be released";
  int ticks = 0;
  double desired = 3.0;
  while (!controller.released() && ticks < 100) {
    desired = std::max(0.0, desired - 1.0);
    const Vector3d force = forceOf(controller.release(input({0.0, 0.0, desired}, kZero)));
    EXPECT_LE((force - before).norm(), kMaxSlew * ForceController::kPeriod + 1e-9);
    before = force;
    ++ticks;
  }
  EXPECT_LE(ticks, 10);
  EXPECT_EQ(controller.release(input(kZero, kZero)), MotorVector::Zero());
}

TEST(ForceController, TheWeightIsHeldWithinTheFadeAndEndsWithTheRest) {
  ForceController controller;
  ForceInput still = input(kZero, kZero);
  still.weight = {1e-4, -2e-4, 3e-4};
  const double step = ForceController::kPeriod / ForceController::kFade;
  EXPECT_TRUE(controller.tick(still).isApprox(step * still.weight, 1e-9));
  for (int i = 0; i < 20; ++i) controller.tick(still);
  EXPECT_TRUE(controller.tick(still).isApprox(still.weight, 1e-9));
  // A device that does not obey may be held by nothing when it does again.
  still.obeyed = false;
  for (int i = 0; i < 20; ++i) controller.tick(still);
  EXPECT_TRUE(controller.tick(still).isZero(1e-12));
  still.obeyed = true;
  for (int i = 0; i < 20; ++i) controller.tick(still);
  for (int i = 0; i < 10; ++i) controller.release(still);
  EXPECT_TRUE(controller.released());
  EXPECT_TRUE(controller.release(still).isZero(0.0));
}

TEST(ForceController, TheWeightIsHeldWithinTheLimitsOfTheTorques) {
  ForceController controller = settled(kZero);
  ForceInput heavy = input(kZero, kZero);
  heavy.weight = MotorVector::Constant(1.0);
  MotorVector torques;
  for (int i = 0; i < 30; ++i) torques = controller.tick(heavy);
  for (int i = 0; i < kMotors; ++i) {
    EXPECT_NEAR(torques[i],
                (kMaxForce + ForceController::kMaxCorrection) * someJacobian().col(i).norm(),
                1e-12);
  }
}

TEST(ForceController, WhateverIsMeasuredTorquesAreFiniteBoundedAndObeyTheSlewLimit) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  const double odd[] = {kNan, std::numeric_limits<double>::infinity(), 1e300, -1e300, 1e-300, 50.0};
  ForceController controller;
  Vector3d desired = kZero, before = kZero;
  const double most = kMaxForce + ForceController::kMaxCorrection;
  double fastest = 0.0;
  for (int i = 0; i < 200000; ++i) {
    if (generator() % 50 == 0) desired = saturated(5.0 * Vector3d(normal(generator), 1.0, 0.0), 5);
    Vector3d measured = 3.0 * Vector3d(normal(generator), normal(generator), normal(generator));
    if (generator() % 20 == 0) measured[generator() % 3] = odd[generator() % 6];
    ForceInput now = input(desired, measured);
    now.sensor_works = generator() % 100 != 0;
    now.obeyed = generator() % 500 > 3;
    const bool releasing = generator() % 1000 == 0;
    const MotorVector torques = releasing ? controller.release(now) : controller.tick(now);
    ASSERT_TRUE(torques.allFinite());
    for (int j = 0; j < kMotors; ++j) {
      ASSERT_LE(std::abs(torques[j]), most * someJacobian().col(j).norm() + 1e-12);
    }
    const Vector3d force = forceOf(torques);
    if (!releasing) {
      ASSERT_LE((force - before).norm(), kMaxSlew * ForceController::kPeriod + 1e-9) << i;
      fastest = std::max(fastest, (force - before).norm());
    }
    before = force;
  }
  EXPECT_GT(fastest, 0.9) << "the test did not go to the limit";
}

TEST(ForceController, TorquesCanBeEncoded) {
  ForceController controller;
  ForceInput long_levers = input({5.0, 0.0, 0.0}, kZero);
  long_levers.jacobian *= 100.0;
  MotorVector torques;
  for (int i = 0; i < 1000; ++i) torques = controller.tick(long_levers);
  EXPECT_LE(torques.cwiseAbs().maxCoeff(), 32767 * kTorqueStep);
  EXPECT_GT(torques.cwiseAbs().maxCoeff(), 32000 * kTorqueStep);
}

// On the emulated fingers, over a line of 3 ms.

FingerMechanics finger(double stiffness) {
  FingerMechanics mechanics;
  mechanics.fingertip_stiffness = stiffness;
  mechanics.fingertip_damping = 2.6 * std::sqrt(stiffness * mechanics.fingertip_mass);
  return mechanics;
}

/// Moves the person's finger to a random place and waits; false if it is near a stop or singular.
bool moveAnywhere(ControlledDevice& device, Finger finger, FingerKinematics& kinematics,
                  std::mt19937& generator) {
  std::uniform_real_distribution<double> share(0.25, 0.75);
  const EmulatedFinger& emulated = device.fingers[finger];
  MotorVector angles;
  for (int i = 0; i < kMotors; ++i) {
    angles[i] =
        emulated.lowest()[i] + share(generator) * (emulated.highest()[i] - emulated.lowest()[i]);
  }
  const JointVector joints = kinematics.jointAngles(angles);
  device.want(finger, kZero);
  device.fingers[finger].setTarget(kinematics.fingertip(joints).translation());
  device.run(1.0);
  return kinematics.configuration(joints).smallest_singular_value > 0.008;
}

bool atAStop(const EmulatedFinger& finger) {
  const MotorVector& angles = finger.motorAngles();
  return (angles - finger.lowest()).minCoeff() < 0.2 ||
         (finger.highest() - angles).minCoeff() < 0.2;
}

Vector3d randomUnit(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
}

TEST(ForceControlOfTheDevice, StaticErrorIsBelowTheSensorsResolution) {
  ControlledDevice device(finger(1000.0), 1, 2);
  ASSERT_TRUE(device.start()) << device.controller.fault();
  std::mt19937 generator(1);
  int poses = 0;
  for (int trial = 0; trial < 100 && poses < 2 * kThoroughness; ++trial) {
    const Finger finger = kFingers[trial % 2];
    FingerKinematics kinematics(shippedUrdf(), finger);
    if (!moveAnywhere(device, finger, kinematics, generator)) continue;
    const double amount = std::min(5.0, 0.05 * std::pow(100.0, poses / 18.0));
    const Vector3d desired = amount * randomUnit(generator);
    device.want(finger, desired);
    device.run(1.2);
    if (atAStop(device.fingers[finger])) continue;
    Vector3d mean = kZero;
    for (int i = 0; i < 200; ++i) {
      device.tick();
      mean += device.fingers[finger].contactForce() / 200.0;
    }
    EXPECT_EQ(device.controller.measured(finger).no_force, NoForceReason::kNone);
    EXPECT_LE((mean - desired).norm(), 0.005) << name(finger) << " " << desired.transpose();
    ++poses;
  }
  EXPECT_EQ(poses, 2 * kThoroughness);
}

TEST(ForceControlOfTheDevice, StepsOvershootByLessThanFifteenPercent) {
  for (const double stiffness : {400.0, 1500.0}) {
    ControlledDevice device(finger(stiffness), 1, 2);
    ASSERT_TRUE(device.start()) << device.controller.fault();
    std::mt19937 generator(2);
    int poses = 0;
    for (int trial = 0; trial < 100 && poses < kThoroughness; ++trial) {
      const Finger finger = kFingers[trial % 2];
      FingerKinematics kinematics(shippedUrdf(), finger);
      if (!moveAnywhere(device, finger, kinematics, generator)) continue;
      const Vector3d direction = randomUnit(generator);
      device.want(finger, 3.0 * direction);
      double peak = 0.0;
      for (int i = 0; i < 600; ++i) {
        device.tick();
        peak = std::max(peak, device.fingers[finger].contactForce().norm());
      }
      if (atAStop(device.fingers[finger])) continue;
      EXPECT_LT(peak, 1.15 * 3.0) << stiffness;
      EXPECT_NEAR(device.fingers[finger].contactForce().dot(direction), 3.0, 0.15) << stiffness;
      ++poses;
    }
    EXPECT_EQ(poses, kThoroughness);
  }
}

/// Amplitude of the force at this frequency (Hz) per that of the desired force.
double gain(ControlledDevice& device, Finger finger, const Vector3d& direction, double frequency) {
  const int settling = 300, periods = 4;
  const int samples = static_cast<int>(std::lround(1000.0 * periods / frequency));
  std::complex<double> sum = 0.0;
  for (int i = 0; i < settling + samples; ++i) {
    const double phase = 2.0 * M_PI * frequency * 0.001 * i;
    device.want(finger, (2.0 + 0.5 * std::sin(phase)) * direction);
    device.tick();
    if (i < settling) continue;
    sum += device.fingers[finger].contactForce().dot(direction) * std::polar(1.0, -phase);
  }
  return 2.0 * std::abs(sum) / samples / 0.5;
}

TEST(ForceControlOfTheDevice, BandwidthAgainstAStiffFingerIsSixHertzOrMore) {
  ControlledDevice device(finger(1500.0), 1, 2);
  ASSERT_TRUE(device.start()) << device.controller.fault();
  std::mt19937 generator(4);
  FingerKinematics kinematics(shippedUrdf(), Finger::kIndex);
  while (!moveAnywhere(device, Finger::kIndex, kinematics, generator)) {
  }
  for (const Vector3d& direction : {Vector3d(0.0, 0.0, 1.0), Vector3d(1.0, 0.0, 1.0)}) {
    const Vector3d unit = direction.normalized();
    for (const double frequency : {1.0, 3.0, 6.0}) {
      const double amplification = gain(device, Finger::kIndex, unit, frequency);
      EXPECT_GT(amplification, std::sqrt(0.5)) << frequency;
      EXPECT_LT(amplification, 1.2) << frequency;
    }
  }
}

TEST(ForceControlOfTheDevice, IsStableOverALineOfTenMilliseconds) {
  for (const double stiffness : {100.0, 400.0, 1500.0}) {
    ControlledDevice device(finger(stiffness), 5, 5);
    ASSERT_TRUE(device.start()) << device.controller.fault();
    device.want(Finger::kThumb, {0.3, 0.0, 0.5});
    device.run(1.0);
    double error = 0.0;
    for (int i = 0; i < 500; ++i) {
      device.tick();
      const Vector3d force = device.fingers[Finger::kThumb].contactForce();
      error = std::max(error, (force - Vector3d(0.3, 0.0, 0.5)).norm());
    }
    EXPECT_LT(error, 0.02) << stiffness;
  }
}

TEST(ForceControlOfTheDevice, WithoutADesiredForceTheFingerMovesFreely) {
  ControlledDevice device(finger(400.0), 1, 2);
  ASSERT_TRUE(device.start()) << device.controller.fault();
  device.want(Finger::kIndex, kZero);
  device.run(1.0);
  EXPECT_LT(device.fingers[Finger::kIndex].contactForce().norm(), 0.02);
  const Vector3d start = device.fingers[Finger::kIndex].fingertip();
  device.fingers[Finger::kIndex].setTarget(start + Vector3d(-0.02, 0.0, -0.03));
  double largest = 0.0;
  for (int i = 0; i < 500; ++i) {
    device.tick();
    largest = std::max(largest, device.fingers[Finger::kIndex].contactForce().norm());
  }
  EXPECT_GT((device.fingers[Finger::kIndex].fingertip() - start).norm(), 0.02);
  EXPECT_LT(largest, 1.0) << "at 0.5 m/s";
  EXPECT_LT(device.fingers[Finger::kIndex].contactForce().norm(), 0.02);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_force_controller
