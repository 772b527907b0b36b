#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "controlled_device.h"
#include "haptex/exoskeleton/control/device_controller.h"

namespace haptex::exoskeleton::test_device_controller {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vector3d kZero = Vector3d::Zero();

TEST(DeviceController, HomesEnablesAndRendersOnBothFingers) {
  ControlledDevice device = rendering(3.0 * kDown);
  const OperatingState& state = device.controller.operatingState();
  EXPECT_EQ(state.mode, Mode::kEnabled);
  EXPECT_TRUE(state.is_homed);
  EXPECT_FALSE(state.is_busy);
  for (const Finger finger : kFingers) {
    EXPECT_EQ(reason(device, finger), NoForceReason::kNone);
    EXPECT_TRUE(device.controller.measured(finger).desired_force.isApprox(3.0 * kDown, 1e-6));
    EXPECT_LT((device.fingers[finger].contactForce() - 3.0 * kDown).norm(), 0.02) << name(finger);
  }
}

TEST(DeviceController, MeasuresInTheHandsBase) {
  ControlledDevice device = rendering(1.0 * kDown);
  for (const Finger finger : kFingers) {
    const FingerMeasurement& measured = device.controller.measured(finger);
    EmulatedFinger& emulated = device.fingers[finger];
    FingerKinematics kinematics(shippedUrdf(), finger);
    const JointVector joints = kinematics.jointAngles(emulated.motorAngles());
    // Homing finds the stops to a count or two, 3 mrad of a motor each.
    EXPECT_LT((measured.joint_angles - joints).cwiseAbs().maxCoeff(), 0.0006);
    EXPECT_LT((measured.pose.translation() - emulated.thimble().translation()).norm(), 1e-4);
    EXPECT_LT((measured.pose.linear() - emulated.thimble().linear()).norm(), 0.002);
    EXPECT_LT((measured.force - emulated.contactForce()).norm(), 0.02);
    EXPECT_LT(measured.velocity.norm(), 0.005);
  }
  EmulatedFinger& index = device.fingers[Finger::kIndex];
  index.setTarget(index.fingertip() + Vector3d(-0.02, 0.0, -0.02));
  device.run(0.04);
  const FingerMeasurement& measured = device.controller.measured(Finger::kIndex);
  const Vector3d velocity = index.motorJacobian() * index.motorVelocities();
  EXPECT_GT(velocity.norm(), 0.1);
  EXPECT_LT((measured.velocity - velocity).norm(), 0.4 * velocity.norm());
  EXPECT_GT(measured.joint_velocities.cwiseAbs().maxCoeff(), 1.0);
}

TEST(DeviceController, NeedsADeviceAndHomingBeforeItIsEnabled) {
  ControlledDevice device;
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
  EXPECT_TRUE(contains(device.controller.enable(), "no states"));
  EXPECT_TRUE(contains(device.controller.home(), "no states"));
  device.run(0.01);
  EXPECT_EQ(reason(device), NoForceReason::kNotHomed);
  EXPECT_TRUE(contains(device.controller.enable(), "home"));
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_EQ(device.controller.home(), "");
  device.run(0.5);
  EXPECT_EQ(reason(device), NoForceReason::kHoming);
  EXPECT_TRUE(device.controller.operatingState().is_busy);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kHoming);
  EXPECT_TRUE(contains(device.controller.enable(), "homing"));
  device.run(6.0);
  EXPECT_EQ(reason(device), NoForceReason::kDisabled);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_EQ(device.controller.enable(), "");
  device.run(0.1);
  EXPECT_EQ(reason(device), NoForceReason::kNoCommand);
  EXPECT_TRUE(contains(device.controller.home(), "DISABLED"));
}

TEST(DeviceController, HomingIsGentle) {
  ControlledDevice device;
  device.run(0.05);
  ASSERT_EQ(device.controller.home(), "");
  double largest = 0.0;
  while (device.controller.operatingState().is_busy && device.now < std::chrono::seconds(12)) {
    device.tick();
    for (const Finger finger : kFingers) {
      largest = std::max(largest, device.fingers[finger].contactForce().norm());
    }
  }
  EXPECT_TRUE(device.controller.operatingState().is_homed) << device.controller.fault();
  EXPECT_LT(largest, 0.7);
}

TEST(DeviceController, HomingThatFailsIsAFaultThatNamesTheJoint) {
  ControlledDevice device;
  device.spoil = [](DeviceState& state) {
    state.fingers[Finger::kThumb].encoder_counts[1] = 5;  // its encoder is dead
  };
  device.run(0.05);
  ASSERT_EQ(device.controller.home(), "");
  device.run(10.5);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kFault);
  EXPECT_FALSE(device.controller.operatingState().is_busy);
  EXPECT_FALSE(device.controller.operatingState().is_homed);
  EXPECT_TRUE(contains(device.controller.fault(), "thumb_cmc")) << device.controller.fault();
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
}

TEST(DeviceController, DisablingEndsHoming) {
  ControlledDevice device;
  device.run(0.05);
  ASSERT_EQ(device.controller.home(), "");
  device.run(0.3);
  EXPECT_EQ(device.controller.disable(), "");
  device.run(0.01);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_EQ(reason(device), NoForceReason::kNotHomed);
}

TEST(DeviceController, AForceIsHeldForTwelveMillisecondsAndEndsEighteenAfterTheLastCommand) {
  ControlledDevice device = rendering(3.0 * kDown);
  for (const Finger finger : kFingers) device.wanted[finger].reset();
  device.run(0.012);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
  device.run(0.006);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(desired(device, Finger::kThumb), 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kNoCommand);
  EXPECT_EQ(device.controller.measured(Finger::kIndex).safety.watchdog_trips, 1u);
  device.run(1.0);
  constexpr double kWeightAndFriction = 0.25;  // N, what motors without torques leave
  EXPECT_LT(device.fingers[Finger::kIndex].contactForce().norm(), kWeightAndFriction);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled) << "a watchdog is no fault";
  for (const Finger finger : kFingers) device.want(finger, 3.0 * kDown);
  device.run(0.5);
  EXPECT_EQ(reason(device), NoForceReason::kNone);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
}

TEST(DeviceController, TheForceOfADeadCommanderEndsAtOnceAndThatOfTheOtherFingerStays) {
  ControlledDevice device = rendering(3.0 * kDown);
  device.wanted[Finger::kIndex].reset();
  device.controller.commanderDied(Finger::kIndex, device.now);
  device.run(0.003);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_NEAR(desired(device, Finger::kThumb), 3.0, 1e-6);
  device.run(0.005);  // for the correction, and a command on its way
  EXPECT_TRUE(device.obeyed.torques[Finger::kIndex].isZero(0.0));
  EXPECT_EQ(reason(device), NoForceReason::kNoCommand);
  device.want(Finger::kIndex, 3.0 * kDown);  // another one commands
  device.run(0.5);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
}

TEST(DeviceController, CommandsThatAreNotFiniteAreDroppedAndCounted) {
  ControlledDevice device = rendering(2.0 * kDown);
  ForceCommand bad;
  bad.force = {0.0, kNan, 0.0};
  device.controller.command(Finger::kIndex, bad, device.now);
  bad.force = kZero;
  bad.stiffness(1, 2) = std::numeric_limits<double>::infinity();
  device.controller.command(Finger::kIndex, bad, device.now);
  device.tick();
  EXPECT_NEAR(desired(device), 2.0, 1e-6) << "the last good command still holds";
  EXPECT_EQ(device.controller.measured(Finger::kIndex).safety.not_finite, 2u);
  EXPECT_EQ(device.controller.measured(Finger::kThumb).safety.not_finite, 0u);
  // Nothing but bad commands is the same as none.
  device.wanted[Finger::kIndex] = bad;
  device.run(0.018);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kNoCommand);
  EXPECT_NEAR(desired(device, Finger::kThumb), 2.0, 1e-6);
}

TEST(DeviceController, CommandsThatOverflowGiveNoForce) {
  ControlledDevice device = rendering(2.0 * kDown);
  ForceCommand overflowing;
  overflowing.stiffness.setConstant(1e308);
  overflowing.position.setConstant(1e10);
  device.wanted[Finger::kIndex] = overflowing;
  device.run(0.1);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_GT(device.controller.measured(Finger::kIndex).safety.not_finite, 90u);
  EXPECT_TRUE(device.obeyed.torques[Finger::kIndex].allFinite());
  device.want(Finger::kIndex, 2.0 * kDown);
  device.run(0.5);
  EXPECT_NEAR(desired(device), 2.0, 1e-6);
}

TEST(DeviceController, ForcesBeyondTheDeviceAreSaturatedAndCounted) {
  ControlledDevice device = rendering(kZero);
  device.want(Finger::kIndex, {0.0, 0.0, 50.0});
  device.run(0.3);
  EXPECT_LE(desired(device), kMaxForce + 1e-9);
  EXPECT_GT(desired(device), 0.99 * kMaxForce);
  EXPECT_GT(device.controller.measured(Finger::kIndex).safety.saturated, 290u);
}

TEST(DeviceController, CommandsForADeviceThatIsNotEnabledAreIgnored) {
  ControlledDevice device = rendering(2.0 * kDown);
  ASSERT_EQ(device.controller.pause(), "");
  device.run(0.1);
  EXPECT_EQ(reason(device), NoForceReason::kPaused);
  EXPECT_EQ(desired(device), 0.0);
  for (const Finger finger : kFingers) device.wanted[finger].reset();
  ASSERT_EQ(device.controller.enable(), "");
  device.run(0.1);
  EXPECT_EQ(reason(device), NoForceReason::kNoCommand) << "the old commands came back";
  EXPECT_EQ(desired(device), 0.0);
}

TEST(DeviceController, PauseAndDisableSwitchTheMotorsOffWithoutAJump) {
  for (const bool pause : {true, false}) {
    ControlledDevice device = rendering(4.0 * kDown);
    EXPECT_EQ(pause ? device.controller.pause() : device.controller.disable(), "");
    Vector3d before = 4.0 * kDown;
    int ticks = 0;
    do {
      device.tick();
      const Eigen::Matrix3d jacobian = device.fingers[Finger::kIndex].motorJacobian();
      const Vector3d force = jacobian.transpose().inverse() * device.obeyed.torques[Finger::kIndex];
      // 1 N of the slew limit, and what damping and a moving finger add.
      if (device.obeyed.mode == DriveMode::kForce) {
        EXPECT_LT((force - before).norm(), 1.5) << ticks;
      }
      before = force;
      ++ticks;
    } while (device.obeyed.mode == DriveMode::kForce && ticks < 100);
    EXPECT_LE(ticks, 12);
    EXPECT_EQ(device.obeyed.torques[Finger::kIndex], MotorVector::Zero());
    EXPECT_EQ(reason(device), pause ? NoForceReason::kPaused : NoForceReason::kDisabled);
    EXPECT_EQ(device.controller.enable(), "");
    device.run(0.1);
    EXPECT_LT(desired(device), 1.0) << "no soft start";
    device.run(0.6);
    EXPECT_NEAR(desired(device), 4.0, 1e-6);
  }
}

TEST(DeviceController, OutsideOfTheLimitsThereIsNoForce) {
  ControlledDevice device = rendering(2.0 * kDown);
  // The transmission of the index finger slips, slowly enough to be taken for motion.
  int slipped = 0, step = 5;
  device.spoil = [&](DeviceState& state) {
    slipped += step;
    state.fingers[Finger::kIndex].encoder_counts[0] += slipped;
  };
  while (reason(device) == NoForceReason::kNone && slipped < 20000) device.tick();
  EXPECT_EQ(reason(device), NoForceReason::kOutsideLimits);
  const FingerKinematics kinematics(shippedUrdf(), Finger::kIndex);
  EXPECT_GT(device.controller.measured(Finger::kIndex).joint_angles[0],
            kinematics.upperLimits()[0] + 0.05);
  device.run(0.2);  // without the force the finger returns a little
  step = 0;
  device.run(0.01);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(reason(device, Finger::kThumb), NoForceReason::kNone);
  step = -5;
  while (reason(device) != NoForceReason::kNone && slipped > 0) device.tick();
  EXPECT_LT(device.controller.measured(Finger::kIndex).joint_angles[0],
            kinematics.upperLimits()[0]);
  EXPECT_LT(desired(device), 0.2) << "it returns by a ramp";
  while (slipped > 0) device.tick();
  step = 0;
  device.run(0.5);
  EXPECT_NEAR(desired(device), 2.0, 1e-6);
}

TEST(DeviceController, InASingularPoseThereIsNoForce) {
  ControlledDevice device = rendering(kZero);
  EmulatedFinger& index = device.fingers[Finger::kIndex];
  FingerKinematics kinematics(shippedUrdf(), Finger::kIndex);
  MotorVector worst = index.lowest();
  double smallest = 1.0;
  for (double a = 0.1; a < 0.95; a += 0.1) {
    for (double b = 0.1; b < 0.95; b += 0.1) {
      MotorVector angles = index.lowest() + 0.5 * (index.highest() - index.lowest());
      angles[1] = index.lowest()[1] + a * (index.highest()[1] - index.lowest()[1]);
      angles[2] = index.lowest()[2] + b * (index.highest()[2] - index.lowest()[2]);
      const double value =
          kinematics.configuration(kinematics.jointAngles(angles)).smallest_singular_value;
      if (value < smallest) worst = angles;
      smallest = std::min(smallest, value);
    }
  }
  ASSERT_LT(smallest, kSingular);
  device.want(Finger::kIndex, {0.0, 0.0, 0.2});
  index.setTarget(kinematics.fingertip(kinematics.jointAngles(worst)).translation());
  device.run(2.0);
  EXPECT_EQ(reason(device), NoForceReason::kSingular);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_LT(index.contactForce().norm(), 0.5);
}

TEST(DeviceController, ASensorThatFailsLeavesTheFeedForward) {
  ControlledDevice device = rendering(3.0 * kDown);
  device.spoil = [](DeviceState& state) {
    state.fingers[Finger::kIndex].force_saturated = true;
    state.fingers[Finger::kIndex].force.z() = 10.0;
    state.fingers[Finger::kThumb].force.x() = kNan;
  };
  double largest = 0.0;
  for (int i = 0; i < 500; ++i) {
    device.tick();
    for (const Finger finger : kFingers) {
      largest = std::max(largest, device.fingers[finger].contactForce().norm());
    }
  }
  for (const Finger finger : kFingers) {
    // Friction and the weight of the links are not compensated any more.
    EXPECT_LT((device.fingers[finger].contactForce() - 3.0 * kDown).norm(), 0.6) << name(finger);
    EXPECT_TRUE(device.controller.measured(finger).force.allFinite());
  }
  EXPECT_LT(largest, 3.6);
  EXPECT_GT(device.controller.measured(Finger::kThumb).safety.not_finite, 490u);
}

TEST(DeviceController, AVirtualWallIsHeldWithoutTrembling) {
  ControlledDevice device = rendering(kZero);
  EmulatedFinger& index = device.fingers[Finger::kIndex];
  const Vector3d surface = index.fingertip();
  ForceCommand wall;
  wall.stiffness(2, 2) = 500.0;  // N/m
  wall.position = surface;
  device.wanted[Finger::kIndex] = wall;
  index.setTarget(surface - Vector3d(0.0, 0.0, 0.01));
  device.run(1.0);
  // Finger and wall share the way as 400 to 500 N/m; the pulp of 1750 N/m is in between.
  const double force = index.contactForce().z();
  EXPECT_NEAR(force, 0.01 / (1.0 / 400 + 1.0 / 500 + 1.0 / 1750), 0.05);
  for (int i = 0; i < 300; ++i) {
    device.tick();
    EXPECT_NEAR(index.contactForce().z(), force, 0.03);
  }
}

TEST(DeviceController, WhateverThePersonTheLineAndTheCommanderDoTorquesAreSafe) {
  ControlledDevice device;
  ASSERT_TRUE(device.start());
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  std::array<Vector3d, 2> before{kZero, kZero};
  const auto once_in = [&](unsigned n) { return generator() % n == 0; };
  int rendered = 0;
  for (int i = 0; i < 3000 * kThoroughness; ++i) {
    if (once_in(800)) device.controller.pause();
    if (once_in(800)) device.controller.disable();
    if (once_in(100)) device.controller.enable();
    if (once_in(3000)) device.controller.raiseFault("test");
    if (once_in(200)) device.controller.clearFault();
    if (once_in(200)) device.states_arrive = !device.states_arrive || once_in(20);
    if (!device.states_arrive && once_in(5)) device.states_arrive = true;
    for (const Finger finger : kFingers) {
      if (once_in(50)) {
        device.want(finger,
                    4.0 * Vector3d(normal(generator), normal(generator), normal(generator)));
        device.wanted[finger]->position = device.fingers[finger].fingertip();
        device.wanted[finger]->stiffness =
            200.0 * std::abs(normal(generator)) * Eigen::Matrix3d::Identity();
      }
      if (once_in(100) && device.wanted[finger]) device.wanted[finger]->force.x() = kNan;
      if (once_in(300)) device.wanted[finger].reset();
    }
    device.tick();
    for (const Finger finger : kFingers) {
      const Vector3d force = device.controller.measured(finger).desired_force;
      Vector3d& last = before[static_cast<std::size_t>(finger)];
      ASSERT_LE((force - last).norm(), 1.0 + 1e-9) << i;
      ASSERT_LE(force.norm(), kMaxForce + 1e-9);
      ASSERT_TRUE(device.obeyed.torques[finger].allFinite());
      ASSERT_LE(device.obeyed.torques[finger].cwiseAbs().maxCoeff(), 32767 * kTorqueStep);
      last = force;
      if (force.norm() > 1.0) ++rendered;
    }
  }
  EXPECT_GT(rendered, 300 * kThoroughness) << "the test hardly rendered a force";
}

TEST(DeviceController, EveryReasonIsSaidInWords) {
  for (const NoForceReason reason :
       {NoForceReason::kNone, NoForceReason::kNoDevice, NoForceReason::kFault,
        NoForceReason::kHoming, NoForceReason::kNotHomed, NoForceReason::kDisabled,
        NoForceReason::kPaused, NoForceReason::kNoCommand, NoForceReason::kOutsideLimits,
        NoForceReason::kSingular}) {
    EXPECT_GT(std::string(describe(reason)).size(), 10u);
  }
}

TEST(DeviceController, RefusesAnUrdfWithoutTheFingers) {
  EXPECT_THROW(DeviceController("<robot name='x'><link name='hand_base'/></robot>"),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_device_controller
