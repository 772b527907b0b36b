#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "emulator_fixtures.h"
#include "haptex/exoskeleton/emulator/emulated_device.h"

namespace haptex::exoskeleton::test_emulated_device {
namespace {

using Eigen::Vector3d;

constexpr double kCount = 2.0 * 3.14159265358979323846 / kCountsPerRevolution;  // rad
constexpr int kSecond = static_cast<int>(EmulatedDevice::kRate);                // in steps

void run(EmulatedDevice& device, const DeviceCommand& command, int steps) {
  for (int i = 0; i < steps; ++i) device.step(command);
}

/// What holds these forces (N, in hand_base) against friction and weight, roughly.
DeviceCommand forces(const EmulatedDevice& device, const Vector3d& index, const Vector3d& thumb) {
  DeviceCommand command;
  command.mode = DriveMode::kForce;
  command.torques[Finger::kIndex] =
      device.finger(Finger::kIndex).motorJacobian().transpose() * index;
  command.torques[Finger::kThumb] =
      device.finger(Finger::kThumb).motorJacobian().transpose() * thumb;
  return command;
}

TEST(EmulatedDevice, CountsFromWhereItWasSwitchedOn) {
  EmulatedDevice device(shippedUrdf(), 1), other(shippedUrdf(), 2);
  PerFinger<MotorVector> start;
  const DeviceState before = device.read();
  for (const Finger finger : kFingers) {
    start[finger] = device.truth(finger).motor_angles;
    EXPECT_GT((start[finger] - other.truth(finger).motor_angles).norm(), 0.1);
    for (const std::int32_t count : before.fingers[finger].encoder_counts) EXPECT_EQ(count, 0);
  }
  for (int i = 0; i < 1000; ++i) {
    run(device, forces(device, Vector3d(0.2, 0.5, -1.0), Vector3d(0.5, 0.5, 1.0)), 8);
    const DeviceState state = device.read();
    for (const Finger finger : kFingers) {
      for (int motor = 0; motor < kMotors; ++motor) {
        const double turned = device.truth(finger).motor_angles[motor] - start[finger][motor];
        EXPECT_LE(std::abs(turned - kCount * state.fingers[finger].encoder_counts[motor]),
                  0.5 * kCount * (1.0 + 1e-9));
      }
    }
  }
  EXPECT_NE(device.read().fingers[Finger::kIndex].encoder_counts[1], 0);
}

TEST(EmulatedDevice, MeasuresTheContactForceInTheFrameOfTheFingertip) {
  EmulatedDevice device(shippedUrdf(), 1);
  run(device, forces(device, Vector3d(0.0, 0.3, 2.0), Vector3d(0.5, 1.0, 0.0)), 2 * kSecond);
  for (const Finger finger : kFingers) {
    const Vector3d expected =
        device.finger(finger).thimble().linear().transpose() * device.truth(finger).contact_force;
    ASSERT_GT(expected.norm(), 0.8);
    Vector3d sum = Vector3d::Zero(), squares = Vector3d::Zero();
    constexpr int kReadings = 20000;
    for (int i = 0; i < kReadings; ++i) {
      const FingerReading reading = device.read().fingers[finger];
      EXPECT_FALSE(reading.force_saturated);
      for (int j = 0; j < 3; ++j) {
        const double steps = reading.force[j] / kForceStep;
        EXPECT_NEAR(steps, std::round(steps), 1e-9);
      }
      sum += reading.force - expected;
      squares += (reading.force - expected).cwiseAbs2();
    }
    // Noise, and rounding with a variance of a twelfth of the squared step. Six standard errors.
    const double variance = std::pow(EmulatedDevice::kForceNoise, 2) + std::pow(kForceStep, 2) / 12;
    const double standard_error = std::sqrt(variance / kReadings);
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(sum[j] / kReadings, 0.0, 6.0 * standard_error);
      EXPECT_NEAR(std::sqrt(squares[j] / kReadings), std::sqrt(variance), 6.0 * standard_error);
    }
  }
}

TEST(EmulatedDevice, SaturatesAtTheEndOfTheSensorsRange) {
  EmulatedDevice device(shippedUrdf(), 1);
  device.saturateSensor(Finger::kThumb, true);
  FingerReading thumb = device.read().fingers[Finger::kThumb];
  EXPECT_TRUE(thumb.force_saturated);
  EXPECT_EQ(thumb.force.maxCoeff(), EmulatedDevice::kForceRange);
  EXPECT_FALSE(device.read().fingers[Finger::kIndex].force_saturated);
  device.saturateSensor(Finger::kThumb, false);
  EXPECT_FALSE(device.read().fingers[Finger::kThumb].force_saturated);

  // A force beyond the range: both push on each other through a device at its current limit.
  EmulatedDevice pushed(shippedUrdf(), 1);
  bool beyond = false;
  for (int i = 0; i < 400 && !beyond; ++i) {
    run(pushed, forces(pushed, Vector3d::Zero(), Vector3d(0.0, -18.0, 0.0)), 8);
    const Vector3d force = pushed.finger(Finger::kThumb).thimble().linear().transpose() *
                           pushed.truth(Finger::kThumb).contact_force;
    const FingerReading reading = pushed.read().fingers[Finger::kThumb];
    EXPECT_LE(reading.force.cwiseAbs().maxCoeff(), EmulatedDevice::kForceRange);
    if (force.cwiseAbs().maxCoeff() < EmulatedDevice::kForceRange + 0.02) continue;
    beyond = true;
    EXPECT_TRUE(reading.force_saturated);
  }
  EXPECT_TRUE(beyond) << "the test did not push hard enough";
}

TEST(EmulatedDevice, LimitsTheMotorsTorques) {
  EmulatedDevice device(shippedUrdf(), 1);
  const double limit = EmulatedDevice::kMaxTorque;
  DeviceCommand command;
  command.mode = DriveMode::kForce;
  command.torques[Finger::kIndex] = MotorVector(1.0, -1.0, 0.5 * limit);
  device.step(command);
  EXPECT_TRUE(
      device.truth(Finger::kIndex)
          .motor_force.isApprox(
              device.finger(Finger::kIndex).forceOf(MotorVector(limit, -limit, 0.5 * limit)),
              1e-12));
}

TEST(EmulatedDevice, TakesTorquesThatAreNotFiniteForNone) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EmulatedDevice device(shippedUrdf(), 1);
    DeviceCommand command;
    command.mode = DriveMode::kForce;
    command.torques[Finger::kIndex] = MotorVector(0.01, bad, 0.01);
    command.torques[Finger::kThumb] = MotorVector(0.01, 0.01, 0.01);
    run(device, command, 8);
    EXPECT_EQ(device.truth(Finger::kIndex).motor_force, Vector3d::Zero());
    EXPECT_TRUE(device.truth(Finger::kIndex).contact_force.allFinite());
    EXPECT_GT(device.truth(Finger::kThumb).motor_force.norm(), 0.1);
  }
}

TEST(EmulatedDevice, HasNoMotorForceWhileItIsOff) {
  EmulatedDevice device(shippedUrdf(), 1);
  DeviceCommand command = forces(device, Vector3d(0, 0, 3), Vector3d(0, 0, 3));
  command.mode = DriveMode::kOff;
  run(device, command, kSecond);
  for (const Finger finger : kFingers) {
    EXPECT_EQ(device.truth(finger).motor_force, Vector3d::Zero());
    EXPECT_LT(device.truth(finger).contact_force.norm(), 0.35);  // its weight and friction
  }
}

TEST(EmulatedDevice, ThePersonLetsHomingMoveTheFingersAndReturns) {
  EmulatedDevice device(shippedUrdf(), 1);
  const Vector3d wanted = device.truth(Finger::kIndex).position;
  DeviceCommand command = forces(device, Vector3d(0, 0, -0.5), Vector3d::Zero());
  command.mode = DriveMode::kHoming;
  run(device, command, kSecond);
  EXPECT_GT((device.truth(Finger::kIndex).position - wanted).norm(), 0.01);
  command = DeviceCommand();
  run(device, command, kSecond);
  EXPECT_LT((device.truth(Finger::kIndex).position - wanted).norm(), 0.002);
}

TEST(EmulatedDevice, FollowsATargetWithinReach) {
  EmulatedDevice device(shippedUrdf(), 1);
  for (const Finger finger : kFingers) {
    const Vector3d target = device.truth(finger).position + Vector3d(0.005, 0.0, 0.005);
    device.setTarget(finger, target);
    run(device, DeviceCommand(), kSecond);
    EXPECT_LT((device.truth(finger).position - target).norm(), 0.0015);  // weight and friction
  }
}

TEST(EmulatedDevice, GoesToTheNearestPlaceForATargetOutOfReach) {
  EmulatedDevice device(shippedUrdf(), 1);
  FingertipReach reach(shippedUrdf(), Finger::kIndex);
  const Vector3d target = device.truth(Finger::kIndex).position + Vector3d(0.3, 0.0, 0.1);
  const Vector3d nearest =
      reach.nearest(target, device.truth(Finger::kIndex).motor_angles).position;
  device.setTarget(Finger::kIndex, target);
  run(device, DeviceCommand(), 2 * kSecond);
  EXPECT_LT((device.truth(Finger::kIndex).position - nearest).norm(), 0.002);
}

TEST(EmulatedDevice, IgnoresATargetThatIsNotFinite) {
  EmulatedDevice device(shippedUrdf(), 1), untouched(shippedUrdf(), 1);
  device.setTarget(Finger::kIndex, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  device.setTarget(Finger::kIndex, {0.0, std::numeric_limits<double>::infinity(), 0.0});
  run(device, DeviceCommand(), kSecond / 4);
  run(untouched, DeviceCommand(), kSecond / 4);
  EXPECT_EQ(device.truth(Finger::kIndex).position, untouched.truth(Finger::kIndex).position);
}

TEST(EmulatedDevice, IsReproducibleBySeed) {
  EmulatedDevice first(shippedUrdf(), 7), same(shippedUrdf(), 7), other(shippedUrdf(), 8);
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    for (EmulatedDevice* device : {&first, &same, &other}) run(*device, DeviceCommand(), 8);
    const Vector3d force = first.read().fingers[Finger::kThumb].force;
    EXPECT_EQ(force, same.read().fingers[Finger::kThumb].force);
    different += force != other.read().fingers[Finger::kThumb].force;
  }
  EXPECT_GT(different, 90);
}

TEST(EmulatedDevice, CountsTheTimeOfItsSteps) {
  EmulatedDevice device(shippedUrdf(), 1);
  EXPECT_EQ(device.read().time, 0u);
  run(device, DeviceCommand(), 12);
  EXPECT_EQ(device.read().time, 1500u);
}

TEST(EmulatedDevice, RefusesAUrdfThatIsNone) {
  EXPECT_THROW(EmulatedDevice("nonsense", 1), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_emulated_device
