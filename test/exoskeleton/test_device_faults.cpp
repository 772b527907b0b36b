#include <gtest/gtest.h>

#include <string>

#include "controlled_device.h"

namespace haptex::exoskeleton::test_device_faults {
namespace {

const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

TEST(DeviceFaults, WithoutStatesItHoldsTheMeasurementAndThenFaults) {
  ControlledDevice device = rendering(3.0 * kDown);
  const FingerMeasurement before = device.controller.measured(Finger::kIndex);
  device.states_arrive = false;
  device.run(0.013);
  EXPECT_EQ(device.controller.measured(Finger::kIndex).pose.matrix(), before.pose.matrix());
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
  device.run(0.005);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled);
  EXPECT_EQ(desired(device), 0.0) << "the device may not get the commands either";
  device.run(0.032);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled) << "silent, but not lost";
  device.run(0.001);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kFault);
  EXPECT_EQ(device.controller.fault(), "no states from the device");
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
  EXPECT_TRUE(contains(device.controller.clearFault(), "no states from the device"));
  device.run(0.1);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  device.states_arrive = true;
  device.run(0.01);
  EXPECT_EQ(reason(device), NoForceReason::kFault);
  EXPECT_EQ(device.controller.clearFault(), "");
  EXPECT_TRUE(device.controller.operatingState().is_homed) << "the device was on all the time";
  EXPECT_EQ(device.controller.enable(), "");
  device.run(1.0);
  EXPECT_LT((device.fingers[Finger::kIndex].contactForce() - 3.0 * kDown).norm(), 0.02);
}

TEST(DeviceFaults, AShortSilenceEndsTheForceAndIsNoFault) {
  ControlledDevice device = rendering(3.0 * kDown);
  device.states_arrive = false;
  device.run(0.030);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
  device.states_arrive = true;
  device.run(0.5);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
}

TEST(DeviceFaults, LosingADeviceWithoutForcesIsNoFault) {
  ControlledDevice device = rendering(kZero);
  ASSERT_EQ(device.controller.disable(), "");
  device.run(0.1);
  device.states_arrive = false;
  device.run(5.0);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kDisabled);
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
  EXPECT_TRUE(contains(device.controller.enable(), "no states"));
  device.states_arrive = true;
  device.run(0.01);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kDisabled);
  EXPECT_TRUE(device.controller.operatingState().is_homed);
  EXPECT_EQ(reason(device), NoForceReason::kDisabled);
}

TEST(DeviceFaults, LosingTheDeviceWhileHomingIsAFault) {
  ControlledDevice device;
  device.run(0.05);
  ASSERT_EQ(device.controller.home(), "");
  device.run(0.3);
  device.states_arrive = false;
  device.run(0.06);
  EXPECT_EQ(device.controller.fault(), "no states from the device");
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
}

TEST(DeviceFaults, CommandsThatDoNotReachTheDeviceEndTheForce) {
  ControlledDevice device = rendering(3.0 * kDown);
  device.commands_arrive = false;
  device.run(0.013);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
  device.run(0.007);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled);
  device.run(0.5);
  device.commands_arrive = true;
  double before = 0.0;
  for (int i = 0; i < 100; ++i) {
    device.tick();
    EXPECT_LE(desired(device) - before, 1.0 + 1e-9);
    before = desired(device);
  }
  device.run(0.5);
  EXPECT_NEAR(desired(device), 3.0, 1e-6);
}

TEST(DeviceFaults, ATrippedWatchdogOfTheDeviceEndsTheForce) {
  ControlledDevice device = rendering(3.0 * kDown);
  device.spoil = [](DeviceState& state) { state.watchdog_tripped = true; };
  device.run(0.006);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kNoDevice);
}

TEST(DeviceFaults, ADeviceThatWasSwitchedOffMustBeHomedAgain) {
  for (const double ran : {1.0, 3000.0}) {  // s: its clock starts over from the past or the future
    ControlledDevice device;
    device.clock_offset = static_cast<std::uint32_t>(1e6 * ran);
    ASSERT_TRUE(device.start());
    device.run(0.01);
    device.clock_offset = static_cast<std::uint32_t>(-device.now.count() / 1000);
    device.count_offset = 0;
    device.run(0.01);
    EXPECT_EQ(device.controller.operatingState().mode, Mode::kFault) << ran;
    EXPECT_TRUE(contains(device.controller.fault(), "switched off")) << device.controller.fault();
    EXPECT_FALSE(device.controller.operatingState().is_homed);
    EXPECT_EQ(device.controller.clearFault(), "");
    EXPECT_TRUE(contains(device.controller.enable(), "home"));
  }
}

TEST(DeviceFaults, TheDevicesClockMayWrapAround) {
  ControlledDevice device;
  device.clock_offset = 0xFFFFFFFFu - 7000000u;  // 7 s before its end
  ASSERT_TRUE(device.start()) << device.controller.fault();
  device.run(4.0);
  EXPECT_EQ(device.controller.operatingState().mode, Mode::kEnabled) << device.controller.fault();
  EXPECT_GT(device.now, std::chrono::seconds(7)) << "it did not wrap around";
}

TEST(DeviceFaults, AnEncoderThatJumpsIsAFaultAndNeedsHoming) {
  ControlledDevice device = rendering(2.0 * kDown);
  device.spoil = [](DeviceState& state) { state.fingers[Finger::kThumb].encoder_counts[2] += 500; };
  device.run(0.01);
  EXPECT_TRUE(contains(device.controller.fault(), "thumb")) << device.controller.fault();
  EXPECT_FALSE(device.controller.operatingState().is_homed);
  device.run(0.01);
  EXPECT_EQ(desired(device), 0.0);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_EQ(device.controller.clearFault(), "");
}

TEST(DeviceFaults, AFaultFromOutsideIsLatched) {
  ControlledDevice device = rendering(5.0 * kDown);
  device.controller.raiseFault("the port /dev/ttyUSB0 is gone");
  double before = desired(device);
  for (int i = 0; i < 5; ++i) {
    device.tick();
    EXPECT_LE(before - desired(device), 1.0 + 1e-9);
    before = desired(device);
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(reason(device), NoForceReason::kFault);
  EXPECT_EQ(device.controller.fault(), "the port /dev/ttyUSB0 is gone");
  device.run(0.02);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_TRUE(contains(device.controller.enable(), "the port /dev/ttyUSB0 is gone"));
  EXPECT_EQ(device.controller.clearFault(), "");
  EXPECT_EQ(device.controller.enable(), "");
  device.run(0.7);
  EXPECT_NEAR(desired(device), 5.0, 1e-6);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_device_faults
