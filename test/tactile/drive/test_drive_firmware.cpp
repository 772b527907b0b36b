// What the electronics promise to do with commands, and without.
#include <gtest/gtest.h>

#include <chrono>

#include "haptex/tactile/drive/drive_firmware.h"

namespace haptex::tactile::test_drive_firmware {
namespace {

using base::Finger;
using base::Time;
using std::chrono::milliseconds;

class Firmware : public ::testing::Test {
 protected:
  void greet(std::uint8_t version = kDriveVersion, std::uint8_t sequence = 0) {
    const serial::Bytes bytes = encode(serial::Hello{version}, sequence, buffer_);
    firmware_.receive(bytes.data, bytes.size, now_);
  }
  void command(double share, std::uint8_t sequence) {
    DriveCommand command;
    command.drive[Finger::kIndex][3] = {share, 0.5 * share};
    const serial::Bytes bytes = encode(command, sequence, buffer_);
    firmware_.receive(bytes.data, bytes.size, now_);
  }
  double share(Time now) { return firmware_.drive(Finger::kIndex, 3, now)[k40]; }

  DriveFirmware firmware_{DriveIdentity{}};
  serial::FrameBuffer buffer_;
  Time now_ = milliseconds(1000);
};

constexpr double kStep = 2.0 * kDriveStep;

TEST_F(Firmware, ObeysNobodyBeforeAHandshakeInItsVersion) {
  command(0.5, 1);
  EXPECT_EQ(firmware_.obeyed(), 0u);
  greet(kDriveVersion + 1);
  command(0.5, 2);
  EXPECT_EQ(firmware_.obeyed(), 0u);
  EXPECT_FALSE(firmware_.answer().empty()) << "another version is told of this one";
  EXPECT_TRUE(firmware_.report(now_).empty());
  greet();
  command(0.5, 1);
  EXPECT_EQ(firmware_.obeyed(), 1u);
  EXPECT_FALSE(firmware_.report(now_).empty());
}

TEST_F(Firmware, GoesToACommandAlongAStraightLine) {
  greet();
  command(0.5, 1);
  EXPECT_EQ(share(now_), 0.0);
  EXPECT_NEAR(share(now_ + kDrivePeriod / 2), 0.25, kStep);
  EXPECT_NEAR(share(now_ + kDrivePeriod), 0.5, kStep);
  // Another one on the way begins where it is.
  now_ += kDrivePeriod / 2;
  const double before = share(now_);
  command(0.1, 2);
  EXPECT_DOUBLE_EQ(share(now_), before);
  EXPECT_NEAR(share(now_ + kDrivePeriod), 0.1, kStep);
}

TEST_F(Firmware, HoldsOverALostCommandAndIsSilentSoonAfterTheSecond) {
  greet();
  command(0.5, 1);
  EXPECT_NEAR(share(now_ + DriveFirmware::kRampStart), 0.5, kStep);
  EXPECT_NEAR(share(now_ + DriveFirmware::kRampStart + DriveFirmware::kRamp / 2), 0.25, kStep);
  EXPECT_FALSE(firmware_.watchdogTripped(now_ + DriveFirmware::kRampStart));
  EXPECT_EQ(share(now_ + DriveFirmware::kSilent), 0.0);
  EXPECT_TRUE(firmware_.watchdogTripped(now_ + DriveFirmware::kSilent));
  EXPECT_LT(DriveFirmware::kSilent, milliseconds(25));
  // And comes back without a jump.
  now_ += milliseconds(50);
  command(0.5, 2);
  EXPECT_EQ(share(now_), 0.0);
  EXPECT_FALSE(firmware_.watchdogTripped(now_));
}

TEST_F(Firmware, AWatchdogWithNothingToSilenceDoesNotTrip) {
  greet();
  command(0.0, 1);
  EXPECT_FALSE(firmware_.watchdogTripped(now_ + milliseconds(100)));
}

TEST_F(Firmware, NeitherOldCommandsNorHellosNorGarbageFeedTheWatchdog) {
  greet();
  command(0.5, 1);
  const Time begin = now_;
  for (int i = 0; i < 18; ++i) {
    now_ += milliseconds(1);
    command(0.5, 1);
    greet(kDriveVersion, 1);
    const std::uint8_t garbage[] = {0xA5, 0x5A, 0xC0, 4, 9, 1, 2, 3};
    firmware_.receive(garbage, sizeof garbage, now_);
  }
  EXPECT_EQ(share(begin + DriveFirmware::kSilent), 0.0);
  EXPECT_EQ(firmware_.obeyed(), 1u);
}

TEST_F(Firmware, ALineThatShowsItsEndIsNotWaitedFor) {
  greet();
  command(0.5, 1);
  now_ += kDrivePeriod;
  firmware_.hangUp(now_);
  EXPECT_NEAR(share(now_), 0.5, kStep);
  EXPECT_EQ(share(now_ + DriveFirmware::kRamp), 0.0);
}

}  // namespace
}  // namespace haptex::tactile::test_drive_firmware
