// The weight of the device's links in a hand that turns: the loop that ships and the emulator.
#include <gtest/gtest.h>

#include "controlled_device.h"
#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/oracles/experiments/device/turning_hand.h"

namespace haptex::exoskeleton::test_turning_hand {
namespace {

constexpr double kFelt = 0.02;    // N
constexpr double kWeight = 0.05;  // N: clearly more, what friction does not carry

PerFinger<oracles::FeltWeight> felt(const oracles::WeightHeld& held) {
  const PerFinger<Eigen::Vector3d> open =
      loadHandPath(HAPTEX_SOURCE_DIRECTORY "/config/paths/pinch.yaml").at(0.0).fingertips;
  return oracles::feltWeight(shippedUrdf(), open, held);
}

TEST(TurningHand, TheWeightOfTheLinksIsNotFeltWithOrWithoutForceSensors) {
  if (kThoroughness < 10) GTEST_SKIP() << "without sanitizers only: 40 s of the device, twice";
  for (const bool by_feedback : {true, false}) {
    const auto found = felt({true, by_feedback});
    for (const Finger finger : kFingers) {
      EXPECT_LE(found[finger].still, kFelt) << name(finger);
      EXPECT_LE(found[finger].turning, kFelt) << name(finger);
    }
  }
}

TEST(TurningHand, WhereNothingHoldsItTheWeightIsFelt) {
  if (kThoroughness < 10) GTEST_SKIP() << "without sanitizers only: 40 s of the device";
  const auto found = felt({false, false});
  for (const Finger finger : kFingers) {
    EXPECT_GT(found[finger].still, kWeight) << name(finger);
    EXPECT_GT(found[finger].turning, kWeight) << name(finger);
  }
}

TEST(TurningHand, TheWeightIsHeldOnlyWhereForcesAreRendered) {
  ControlledDevice device = rendering(Eigen::Vector3d::Zero());
  const auto live = [&](int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      device.controller.setGravity(kDown * base::kStandardGravity, device.now);
      device.tick();
    }
  };
  live(200);
  EXPECT_EQ(device.controller.gravity(), kDown * base::kStandardGravity);
  EXPECT_GT(device.obeyed.torques[Finger::kIndex].norm(), 1e-5);
  ASSERT_EQ(device.controller.disable(), "");
  live(50);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_TRUE(device.obeyed.torques[Finger::kIndex].isZero(0.0));
  ASSERT_EQ(device.controller.enable(), "");
  live(700);
  device.controller.raiseFault("for the test");
  live(50);
  EXPECT_EQ(device.obeyed.mode, DriveMode::kOff);
  EXPECT_TRUE(device.obeyed.torques[Finger::kIndex].isZero(0.0));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_turning_hand
