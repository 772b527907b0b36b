// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <limits>

#include "../malloc_counter.h"
#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/exoskeleton/emulator/emulated_device.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton::test_allocation {
namespace {

TEST(ExoskeletonAllocation, KinematicsDoNotAllocateAfterConstruction) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  FingerKinematics finger(shippedUrdf(), Finger::kIndex);
  const long before = allocations;
  double sum = 0.0;
  for (int i = 0; i < 100; ++i) {
    const JointVector at = finger.jointAngles(MotorVector(0.1, 5.0, 0.1 * i));
    sum += finger.fingertip(at).translation().sum() + finger.motorJacobian(at).sum() +
           finger.motorWeight(at).sum() + finger.configuration(at).smallest_singular_value +
           finger.motorAngles(at).sum();
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
  EXPECT_NE(sum, 0.0);
}

TEST(ExoskeletonAllocation, TheEmulatedDeviceDoesNotAllocateAfterConstruction) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  EmulatedDevice device(shippedUrdf(), 1);
  const long before = allocations;
  DeviceCommand command;
  for (const DriveMode mode : {DriveMode::kForce, DriveMode::kHoming, DriveMode::kOff}) {
    command.mode = mode;
    command.torques[Finger::kIndex].setConstant(0.01);
    device.setTarget(Finger::kThumb, {0.1, 0.0, 0.01 * static_cast<int>(mode)});
    for (int i = 0; i < 800; ++i) device.step(command);
    device.saturateSensor(Finger::kIndex, mode == DriveMode::kHoming);
    EXPECT_EQ(device.read().fingers[Finger::kIndex].force_saturated, mode == DriveMode::kHoming);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
}

TEST(ExoskeletonAllocation, TheControllersTickDoesNotAllocateWhateverHappens) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  EmulatedDevice device(shippedUrdf(), 1);
  DeviceController controller(shippedUrdf());
  ForceCommand force;
  force.force = {0.0, 0.5, 1.0};
  ForceCommand bad;
  bad.force.setConstant(std::numeric_limits<double>::quiet_NaN());
  Time now{0};
  const auto run = [&](int ticks, bool connected) {
    const long before = allocations;
    for (int i = 0; i < ticks; ++i) {
      now += std::chrono::milliseconds(1);
      const DeviceState state = device.read();
      controller.command(Finger::kIndex, i % 7 == 0 ? bad : force, now);
      controller.setGravity({0.0, 6.0, -7.0}, now);
      const DeviceCommand& command = controller.tick(connected ? &state : nullptr, now);
      for (int step = 0; step < 8; ++step) device.step(command);
    }
    return allocations - before;
  };
  EXPECT_EQ(run(50, true), 0);
  ASSERT_EQ(controller.home(), "");
  EXPECT_EQ(run(7000, true), 0);
  ASSERT_EQ(controller.enable(), "");
  EXPECT_EQ(run(1000, true), 0);
  EXPECT_EQ(controller.measured(Finger::kIndex).no_force, NoForceReason::kNone);
  EXPECT_EQ(run(100, false), 0);
  EXPECT_EQ(controller.fault(), "no states from the device") << "no fault was raised in a tick";
  EXPECT_EQ(run(100, true), 0);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_allocation
