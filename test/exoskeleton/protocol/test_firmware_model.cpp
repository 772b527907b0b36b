#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_firmware_model {
namespace {

constexpr int kSteps = 1000;

void receive(FirmwareModel& device, const ByteVector& bytes, Time now) {
  device.receive(bytes.data(), bytes.size(), now);
}

void obey(FirmwareModel& device, int number, Time now, DriveMode mode = DriveMode::kForce) {
  receive(device, frameOf(commandOf(mode, kSteps), static_cast<std::uint8_t>(number)), now);
}

/// A device that has obeyed commands 1 to 20 once a millisecond, the last at `end`.
FirmwareModel drivenUntil(Time end) {
  FirmwareModel device(Identity{});
  receive(device, frameOf(Hello{kProtocolVersion}), end - milliseconds(20));
  for (int i = 1; i <= 20; ++i) obey(device, i, end - milliseconds(20 - i));
  return device;
}

DeviceState reported(FirmwareModel& device, Time now) {
  const ByteVector bytes = copy(device.report({}, now));
  return decodeState(frameIn(bytes, LineEnd::kDriver)).value();
}

double shareAt(FirmwareModel& device, Time now) {
  return device.command(now).torques[Finger::kIndex][0] / (kSteps * kTorqueStep);
}

TEST(FirmwareModel, AnswersEveryHelloOnceWithItsIdentity) {
  const Identity identity{kProtocolVersion, 5, 6, 7};
  FirmwareModel device(identity);
  EXPECT_TRUE(device.answer().empty());
  receive(device, frameOf(Hello{kProtocolVersion}), milliseconds(0));
  EXPECT_EQ(copy(device.answer()), frameOf(identity));
  EXPECT_TRUE(device.answer().empty());
  device.report({}, milliseconds(1));
  receive(device, frameOf(Hello{kProtocolVersion}), milliseconds(1));
  EXPECT_EQ(copy(device.answer()), frameOf(identity, 1)) << "carries the number of the last state";
}

TEST(FirmwareModel, ReportsNothingBeforeTheHandshakeAndNumbersItsStates) {
  FirmwareModel device(Identity{});
  EXPECT_TRUE(device.report({}, milliseconds(0)).empty());
  receive(device, frameOf(Hello{kProtocolVersion}), milliseconds(0));
  for (const std::uint8_t number : {1, 2, 3}) {
    const ByteVector bytes = copy(device.report(stateAt(5), milliseconds(number)));
    EXPECT_EQ(frameIn(bytes, LineEnd::kDriver).sequence, number);
    EXPECT_EQ(decodeState(frameIn(bytes, LineEnd::kDriver))->time, 5u);
  }
}

TEST(FirmwareModel, IgnoresCommandsBeforeTheHandshake) {
  FirmwareModel device(Identity{});
  obey(device, 1, milliseconds(0));
  EXPECT_TRUE(equal(device.command(milliseconds(3)), DeviceCommand{}));
  receive(device, frameOf(Hello{kProtocolVersion}), milliseconds(4));
  EXPECT_TRUE(equal(device.command(milliseconds(4)), DeviceCommand{}));
  obey(device, 1, milliseconds(5));
  EXPECT_EQ(device.command(milliseconds(9)).mode, DriveMode::kForce);
}

TEST(FirmwareModel, AnswersADriverOfAnotherVersionButDoesNotObeyIt) {
  FirmwareModel device(Identity{});
  receive(device, frameOf(Hello{2}), milliseconds(0));
  EXPECT_EQ(copy(device.answer()), frameOf(Identity{}));
  EXPECT_TRUE(device.report({}, milliseconds(1)).empty());
  obey(device, 1, milliseconds(1));
  EXPECT_TRUE(equal(device.command(milliseconds(2)), DeviceCommand{}));
}

TEST(FirmwareModel, TellsWhatItDoes) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  DeviceState state = reported(device, milliseconds(100));
  EXPECT_EQ(state.last_command, 20);
  EXPECT_EQ(state.mode, DriveMode::kForce);
  EXPECT_FALSE(state.watchdog_tripped);
  obey(device, 21, milliseconds(101), DriveMode::kHoming);
  state = reported(device, milliseconds(101));
  EXPECT_EQ(state.last_command, 21);
  EXPECT_EQ(state.mode, DriveMode::kHoming);
}

TEST(FirmwareModel, HoldsThenGoesStraightToZeroWithinTwentyMilliseconds) {
  const Time last = milliseconds(100);
  FirmwareModel device = drivenUntil(last);
  for (int us = 0; us <= 30000; us += 125) {
    const double expected = std::min(1.0, std::max(0.0, (19000 - us) / 5000.0));
    EXPECT_NEAR(shareAt(device, last + microseconds(us)), expected, 1e-12) << us;
    const DriveMode mode = us < 19000 ? DriveMode::kForce : DriveMode::kOff;
    EXPECT_EQ(device.command(last + microseconds(us)).mode, mode) << us;
  }
}

TEST(FirmwareModel, GoesToZeroAtOnceWhenTheDriversEndIsClosed) {
  const Time last = milliseconds(100);
  for (const int closed : {0, 1000, 13000, 16000, 18500}) {
    FirmwareModel device = drivenUntil(last);
    for (int us = closed; us <= 30000; us += 125) {
      device.hangUp(last + microseconds(us));  // as long as it is closed
      const double silent = std::min(1.0, std::max(0.0, (19000 - us) / 5000.0));
      const double hung_up = std::max(0.0, (closed + 5000 - us) / 5000.0);
      EXPECT_NEAR(shareAt(device, last + microseconds(us)), std::min(silent, hung_up), 1e-12)
          << closed << ", " << us;
    }
    EXPECT_EQ(device.command(last + microseconds(closed + 5000)).mode, DriveMode::kOff);
    EXPECT_TRUE(reported(device, milliseconds(130)).watchdog_tripped);
    obey(device, 21, milliseconds(140));  // a driver is there again
    EXPECT_FALSE(reported(device, milliseconds(140)).watchdog_tripped);
    EXPECT_LE(shareAt(device, milliseconds(142)), 0.1 + 1e-12);
  }
}

TEST(FirmwareModel, IsNotSwitchedOnByAnEndThatIsClosed) {
  FirmwareModel device{Identity{}};
  device.hangUp(milliseconds(100));
  EXPECT_TRUE(equal(device.command(milliseconds(100)), DeviceCommand{}));
}

TEST(FirmwareModel, HasTrippedFromTheEndOfTheRampUntilTheNextCommand) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  EXPECT_FALSE(reported(device, microseconds(118999)).watchdog_tripped);
  EXPECT_TRUE(reported(device, microseconds(119000)).watchdog_tripped);
  EXPECT_EQ(reported(device, microseconds(119000)).mode, DriveMode::kOff);
  receive(device, frameOf(Hello{kProtocolVersion}, 20), milliseconds(5000));
  EXPECT_TRUE(reported(device, milliseconds(5000)).watchdog_tripped);
  obey(device, 21, milliseconds(5001));
  EXPECT_FALSE(reported(device, milliseconds(5001)).watchdog_tripped);
}

TEST(FirmwareModel, DoesNotTripWhileTheMotorsAreOff) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  obey(device, 21, milliseconds(101), DriveMode::kOff);
  EXPECT_TRUE(equal(device.command(milliseconds(101)), DeviceCommand{})) << "off means no torque";
  EXPECT_FALSE(reported(device, milliseconds(500)).watchdog_tripped);
}

TEST(FirmwareModel, ComesBackWithinTwentyMillisecondsAndNoSooner) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  EXPECT_NEAR(shareAt(device, microseconds(117500)), 0.3, 1e-12);
  for (int i = 0; i < 30; ++i) {
    const Time now = microseconds(117500 + 1000 * i);
    obey(device, 21 + i, now);
    EXPECT_NEAR(shareAt(device, now), std::min(1.0, 0.3 + 0.05 * i), 1e-12);
  }
  double before = shareAt(device, microseconds(146500));
  // Whatever the pattern of delays, the torque changes by a fifth per millisecond at most.
  std::mt19937 generator(4);
  int number = 51;
  for (long us = 146500; us < 3000000; us += 250) {
    if (generator() % 50 == 0) obey(device, number++, microseconds(us));
    const double share = shareAt(device, microseconds(us));
    EXPECT_LE(std::abs(share - before), 0.05 + 1e-9) << us;
    before = share;
  }
}

TEST(FirmwareModel, GoesToACommandAfterLostOnesInTheTimeTheDriverTook) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  const DeviceCommand twice = commandOf(DriveMode::kForce, 2 * kSteps);
  for (int ms = 4; ms <= 10; ++ms) {  // 21 to 23 are lost
    receive(device, frameOf(twice, static_cast<std::uint8_t>(20 + ms)), milliseconds(100 + ms));
    EXPECT_NEAR(shareAt(device, milliseconds(100 + ms)), std::min(2.0, ms / 4.0), 0.06) << ms;
  }
}

TEST(FirmwareModel, ChangesNoFasterThanTheDriverDidWhenManyCommandsComeAtOnce) {
  constexpr int kCommands = 30, kChange = 100;  // per command, a tenth of what there was
  for (const int together : {1, 2, 4}) {
    FirmwareModel device = drivenUntil(milliseconds(100));
    const auto command = [&](int number) {
      return frameOf(commandOf(DriveMode::kForce, kSteps + kChange * std::min(number, kCommands)),
                     static_cast<std::uint8_t>(20 + number));
    };
    int number = 0;
    std::vector<double> shares{1.0};
    for (long us = 0; us < 100000; us += 250) {
      // One in every 0.25 ms, but only after `together` of them have piled up.
      const long sent = us / 1000 / together * together;
      if (number < sent) receive(device, command(++number), milliseconds(100) + microseconds(us));
      shares.push_back(shareAt(device, milliseconds(100) + microseconds(us)));
      if (shares.size() < 5) continue;
      const double change = shares.back() - shares[shares.size() - 5];  // in a millisecond
      EXPECT_LE(std::abs(change), 0.1 * 1.15 + 1e-9) << us;
    }
    EXPECT_NEAR(shares.back(), 1.0 + 0.1 * kCommands, 1e-9) << together;
  }
}

TEST(FirmwareModel, RepeatedAndOldCommandsDoNotFeedTheWatchdog) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  for (int ms = 101; ms <= 119; ++ms) obey(device, 20, milliseconds(ms));
  EXPECT_TRUE(equal(device.command(milliseconds(119)), DeviceCommand{}));
  device = drivenUntil(milliseconds(100));
  for (int ms = 101; ms <= 119; ++ms) obey(device, ms - 99, milliseconds(ms));
  EXPECT_TRUE(equal(device.command(milliseconds(119)), DeviceCommand{}));
}

TEST(FirmwareModel, GarbageAndCorruptCommandsDoNotFeedTheWatchdog) {
  std::mt19937 generator(5);
  FirmwareModel device = drivenUntil(milliseconds(100));
  int number = 21;
  for (long us = 100000; us < 119000; us += 100) {
    ByteVector bytes(generator() % 30);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(generator());
    ByteVector bad =
        frameOf(commandOf(DriveMode::kForce, kSteps), static_cast<std::uint8_t>(number++));
    bad[2 + generator() % 18] ^= static_cast<std::uint8_t>(1 << generator() % 8);
    append(bytes, bad);
    append(bytes, frameOf(Hello{kProtocolVersion}, static_cast<std::uint8_t>(number)));
    DeviceCommand meaningless = commandOf(DriveMode::kForce, kSteps);
    meaningless.mode = static_cast<DriveMode>(7);
    append(bytes, frameOf(meaningless, static_cast<std::uint8_t>(number + 1)));
    FrameBuffer buffer;
    const ByteVector good =
        frameOf(commandOf(DriveMode::kForce, kSteps), static_cast<std::uint8_t>(number + 2));
    append(bytes, copy(serial::inVersion(view(good), kProtocolVersion + 1, kFrameLayout, buffer)));
    receive(device, bytes, microseconds(us));
    EXPECT_NEAR(shareAt(device, microseconds(us)),
                std::min(1.0, static_cast<double>(119000 - us) / 5000.0), 1e-12);
  }
  EXPECT_TRUE(equal(device.command(milliseconds(119)), DeviceCommand{}));
  EXPECT_GE(device.received().corrupt_frames, 150u);
}

TEST(FirmwareModel, AHelloChangesNothingAboutTheRamp) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  receive(device, frameOf(Hello{kProtocolVersion}), milliseconds(102));
  EXPECT_DOUBLE_EQ(shareAt(device, milliseconds(102)), 1.0);
  EXPECT_NEAR(shareAt(device, microseconds(116500)), 0.5, 1e-12);
  EXPECT_TRUE(equal(device.command(milliseconds(119)), DeviceCommand{}));
}

TEST(FirmwareModel, ObeysANewDriverThatCountsAnew) {
  FirmwareModel device = drivenUntil(milliseconds(100));  // up to number 20
  receive(device, frameOf(Hello{kProtocolVersion}, 0), milliseconds(300));
  obey(device, 1, milliseconds(301), DriveMode::kHoming);
  EXPECT_EQ(device.command(milliseconds(301)).mode, DriveMode::kHoming);
  EXPECT_EQ(reported(device, milliseconds(301)).last_command, 1);
}

TEST(FirmwareModel, TheLastCommandOfADeadDriverIsNotObeyedAgainAfterAHello) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  receive(device, frameOf(Hello{kProtocolVersion}, 0), milliseconds(300));
  obey(device, 20, milliseconds(301));
  EXPECT_TRUE(equal(device.command(milliseconds(301)), DeviceCommand{}));
  EXPECT_TRUE(reported(device, milliseconds(301)).watchdog_tripped);
}

TEST(FirmwareModel, ACommandThatWasInterruptedForTenMillisecondsIsDropped) {
  FirmwareModel device = drivenUntil(milliseconds(100));
  const ByteVector command = frameOf(commandOf(DriveMode::kForce, kSteps), 21);
  device.receive(command.data(), 19, milliseconds(101));
  device.receive(command.data() + 19, 1, milliseconds(111));
  EXPECT_EQ(reported(device, milliseconds(111)).last_command, 20);
  device.receive(command.data(), 19, milliseconds(112));
  device.receive(command.data() + 19, 1, milliseconds(113));
  EXPECT_EQ(reported(device, milliseconds(113)).last_command, 21);
}

TEST(FirmwareModel, ObeysAgainAfterALineThatWasSilentForAnyTime) {
  for (int lost = 0; lost < 600; ++lost) {
    FirmwareModel device = drivenUntil(milliseconds(100));
    const Time again = milliseconds(100 + lost);
    int ms = 1;
    const auto obeyed = [&](int number) {
      return reported(device, again + milliseconds(ms)).last_command == number % 256;
    };
    for (obey(device, 20 + lost + ms, again + milliseconds(ms)); !obeyed(20 + lost + ms);) {
      ++ms;
      ASSERT_LE(ms, serial::kOldNumbers + 2) << lost;
      obey(device, 20 + lost + ms, again + milliseconds(ms));
    }
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_firmware_model
