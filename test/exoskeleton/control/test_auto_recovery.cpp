#include <gtest/gtest.h>

#include "controlled_device.h"
#include "haptex/base/workload.h"
#include "haptex/exoskeleton/control/auto_recovery.h"

namespace haptex::exoskeleton::test_auto_recovery {
namespace {

using std::chrono::milliseconds;

/// Carries out the steps on a device in the closed loop.
struct Recovering {
  ControlledDevice device = rendering(2.0 * kDown);
  AutoRecovery recovery;
  int given_up = 0;

  void run(double duration) {
    for (int i = 0; i < static_cast<int>(1000.0 * duration); ++i) {
      device.tick();
      const DeviceController& now = device.controller;
      switch (recovery.next(now.operatingState(), now.faultIsAStall(), device.now)) {
        case RecoveryStep::kClearFault:
          device.controller.clearFault();
          break;
        case RecoveryStep::kHome:
          device.controller.home();
          break;
        case RecoveryStep::kEnable:
          device.controller.enable();
          break;
        case RecoveryStep::kGiveUp:
          ++given_up;
          break;
        case RecoveryStep::kNone:
          break;
      }
    }
  }
  void stall(double duration) {
    device.states_arrive = false;
    run(duration);
    device.states_arrive = true;
  }
  Mode mode() const { return device.controller.operatingState().mode; }
};

TEST(AutoRecovery, EnablesAgainAfterAStallWithASoftStart) {
  Recovering all;
  all.run(0.1);
  all.stall(0.5);
  EXPECT_EQ(all.mode(), Mode::kFault);
  all.run(0.45);
  ASSERT_EQ(all.mode(), Mode::kEnabled) << all.device.controller.fault();
  EXPECT_LT(desired(all.device), 1.5) << "no soft start";
  all.run(0.6);
  EXPECT_NEAR(desired(all.device), 2.0, 1e-6);
  EXPECT_FALSE(all.recovery.isRecovering());
}

TEST(AutoRecovery, GivesUpAfterThreeStallsInARowUntilAPersonEnables) {
  Recovering all;
  all.run(0.1);
  for (int i = 0; i < AutoRecovery::kMaxInARow; ++i) {
    EXPECT_EQ(all.given_up, 0);
    all.stall(0.2);
    all.run(1.0);
    ASSERT_EQ(all.mode(), Mode::kEnabled) << i;
  }
  all.stall(0.2);
  all.run(5.0);
  EXPECT_EQ(all.mode(), Mode::kFault);
  EXPECT_EQ(all.given_up, 1);
  ASSERT_EQ(all.device.controller.clearFault(), "");
  all.run(1.0);
  EXPECT_EQ(all.mode(), Mode::kDisabled) << "only a person enables now";
  ASSERT_EQ(all.device.controller.enable(), "");
  all.run(0.1);
  all.stall(0.2);
  all.run(1.0);
  EXPECT_EQ(all.mode(), Mode::kEnabled);
}

TEST(AutoRecovery, StallsThatAreFarApartAreNotInARow) {
  Recovering all;
  all.run(0.1);
  constexpr int kMost = AutoRecovery::kMaxInARow;
  for (int i = 0; i < base::unlessSanitized(2 * kMost, kMost + 1); ++i) {
    all.stall(0.2);
    all.run(11.0);
    ASSERT_EQ(all.mode(), Mode::kEnabled) << i;
  }
}

TEST(AutoRecovery, LeavesFaultsOfTheDeviceToAPerson) {
  Recovering all;
  all.run(0.1);
  all.device.controller.raiseFault("the serial port was closed");
  all.run(2.0);
  EXPECT_EQ(all.mode(), Mode::kFault);
  EXPECT_EQ(all.given_up, 0);
  ASSERT_EQ(all.device.controller.clearFault(), "");
  all.run(2.0);
  EXPECT_EQ(all.mode(), Mode::kDisabled);
}

TEST(AutoRecovery, DoesNotEnableWhatAPersonHasDisabledOrPaused) {
  for (const bool pause : {false, true}) {
    Recovering all;
    all.run(0.1);
    ASSERT_EQ(pause ? all.device.controller.pause() : all.device.controller.disable(), "");
    all.run(1.0);
    const Mode asked = all.mode();
    all.stall(0.2);
    all.run(2.0);
    EXPECT_EQ(all.mode(), asked);
  }
}

TEST(AutoRecovery, HomesOnlyADeviceThatHasLostItsCalibration) {
  AutoRecovery recovery;
  OperatingState state;
  state.is_homed = true;
  state.mode = Mode::kEnabled;
  Time now = milliseconds(1000);
  EXPECT_EQ(recovery.next(state, false, now), RecoveryStep::kNone);
  state.mode = Mode::kFault;
  EXPECT_EQ(recovery.next(state, true, now), RecoveryStep::kNone) << "not at once";
  now += AutoRecovery::kPeriod;
  EXPECT_EQ(recovery.next(state, true, now), RecoveryStep::kClearFault);
  state.mode = Mode::kDisabled;
  state.is_homed = false;
  now += AutoRecovery::kPeriod;
  EXPECT_EQ(recovery.next(state, false, now), RecoveryStep::kHome);
  state.is_busy = true;
  now += AutoRecovery::kPeriod;
  EXPECT_EQ(recovery.next(state, false, now), RecoveryStep::kNone);
  state.is_busy = false;
  state.is_homed = true;
  EXPECT_EQ(recovery.next(state, false, now), RecoveryStep::kEnable);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_auto_recovery
