// The frames of the drive electronics, their worked examples in docs/tactile_protocol.md among
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/serial/line_descriptor.h"
#include "haptex/tactile/drive/drive_firmware.h"
#include "haptex/tactile/drive/drive_protocol.h"

namespace haptex::tactile::test_drive_protocol {
namespace {

using base::Finger;
using serial::Bytes;
using serial::FrameVerdict;
using serial::LineEnd;

template <typename Message>
std::vector<std::uint8_t> frameOf(const Message& message, std::uint8_t sequence = 0) {
  serial::FrameBuffer buffer;
  const Bytes bytes = encode(message, sequence, buffer);
  return {bytes.data, bytes.data + bytes.size};
}

serial::Frame frameIn(const std::vector<std::uint8_t>& bytes, LineEnd end) {
  const serial::Inspection found = inspect({bytes.data(), bytes.size()}, end, kDriveLayout);
  EXPECT_EQ(found.verdict, FrameVerdict::kGood);
  return found.frame;
}

DriveCommand sent(const DriveCommand& command) {
  const std::vector<std::uint8_t> bytes = frameOf(command);
  const auto decoded = decodeDriveCommand(frameIn(bytes, LineEnd::kDevice));
  EXPECT_TRUE(decoded);
  return decoded.value_or(DriveCommand{});
}

TEST(DriveProtocol, EveryShareArrivesAtItsContactorWithinAStep) {
  DriveCommand command;
  for (const Finger finger : base::kFingers) {
    for (int i = 0; i < kContactors; ++i) {
      command.drive[finger][i] = {0.01 * i + 0.001, finger == Finger::kThumb ? 0.5 : 0.25};
    }
  }
  const DriveCommand arrived = sent(command);
  for (const Finger finger : base::kFingers) {
    for (int i = 0; i < kContactors; ++i) {
      for (const Channel channel : {k40, k320}) {
        const double rounded =
            command.drive[finger][i][channel] - arrived.drive[finger][i][channel];
        EXPECT_GE(rounded, -1e-15);  // never more than was asked for
        EXPECT_LT(rounded, kDriveStep);
      }
    }
  }
}

TEST(DriveProtocol, WhatIsNoShareIsZeroAndTwoChannelsNeverPassFullDrive) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  DriveCommand command;
  ArrayDrive& drive = command.drive[Finger::kIndex];
  drive[0] = {std::nan(""), kInfinity};
  drive[1] = {-0.5, -kInfinity};
  drive[2] = {2.0, 0.5};
  drive[3] = {0.75, 0.75};
  const ArrayDrive arrived = sent(command).drive[Finger::kIndex];
  EXPECT_EQ(arrived[0], (PerChannel<double>{0.0, 0.0}));
  EXPECT_EQ(arrived[1], (PerChannel<double>{0.0, 0.0}));
  EXPECT_EQ(arrived[2], (PerChannel<double>{1.0, 0.0}));
  EXPECT_NEAR(arrived[3][k40] + arrived[3][k320], 1.0, 1e-12);
}

TEST(DriveProtocol, RefusesFieldsThatMeanNothing) {
  std::vector<std::uint8_t> command = frameOf(DriveCommand{});
  for (int at = 5; at < 9; ++at) command[at] = 0xFF;  // both channels of a contactor at full drive
  serial::Frame frame = frameIn(frameOf(DriveCommand{}), LineEnd::kDevice);
  frame.payload = {command.data() + 5, kDriveLayout.command_payload};
  EXPECT_FALSE(decodeDriveCommand(frame));

  const std::vector<std::uint8_t> state = {0, 2};  // an unknown flag
  frame.type = serial::FrameType::kState;
  frame.payload = {state.data(), state.size()};
  EXPECT_FALSE(decodeDriveState(frame));

  const std::vector<std::uint8_t> other = frameOf(DriveIdentity{kDriveVersion, 1, 1, 32});
  EXPECT_FALSE(decodeDriveIdentity(frameIn(other, LineEnd::kDriver))) << "another array";
}

TEST(DriveProtocol, StatesAndIdentitiesArrive) {
  const auto state_bytes = frameOf(DriveState{17, true});
  const auto state = decodeDriveState(frameIn(state_bytes, LineEnd::kDriver));
  ASSERT_TRUE(state);
  EXPECT_EQ(state->last_command, 17);
  EXPECT_TRUE(state->watchdog_tripped);
  const auto identity_bytes = frameOf(DriveIdentity{kDriveVersion, 258, 1234567, kContactors});
  const auto identity = decodeDriveIdentity(frameIn(identity_bytes, LineEnd::kDriver));
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->firmware, 258);
  EXPECT_EQ(identity->serial_number, 1234567u);
}

TEST(DriveProtocol, ACommandTakesLessThanHalfOfItsPeriodOnTheLine) {
  const double bits = 10.0 * static_cast<double>(frameOf(DriveCommand{}).size());
  EXPECT_LT(bits / serial::kBaudRate, 0.5 * base::seconds(kDrivePeriod));
  // Samples of 48 signals at ten times the highest frequency do not fit.
  EXPECT_GT(48 * 10.0 * 320.0 * 20.0, serial::kBaudRate);
}

// Whoever takes the wrong port finds another version, and neither obeys the other.
TEST(DriveProtocol, AnExoskeletonAndAnArrayDoNotTakeEachOtherForTheirOwn) {
  DriveLink array_driver;
  exoskeleton::FirmwareModel exoskeleton(exoskeleton::Identity{});
  Bytes bytes = array_driver.poll(base::Time{0});
  exoskeleton.receive(bytes.data, bytes.size, base::Time{0});
  bytes = exoskeleton.answer();
  array_driver.receive(bytes.data, bytes.size, base::Time{0});
  EXPECT_EQ(array_driver.status(), serial::LinkStatus::kVersionMismatch);
  EXPECT_TRUE(exoskeleton.report({}, base::Time{0}).empty()) << "greeted by a stranger";

  exoskeleton::DeviceLink device_driver;
  DriveFirmware array(DriveIdentity{});
  bytes = device_driver.poll(base::Time{0});
  array.receive(bytes.data, bytes.size, base::Time{0});
  bytes = array.answer();
  device_driver.receive(bytes.data, bytes.size, base::Time{0});
  EXPECT_EQ(device_driver.status(), serial::LinkStatus::kVersionMismatch);
  EXPECT_TRUE(array.report(base::Time{0}).empty());
}

TEST(DriveProtocol, TheWorkedExamplesAreWhatIsSent) {
  std::ifstream page(std::string(HAPTEX_SOURCE_DIRECTORY) + "/docs/tactile_protocol.md");
  std::vector<std::string> examples;
  for (std::string line; std::getline(page, line);) {
    for (const char* name : {"    Hello: ", "    Identity: ", "    State: "}) {
      if (line.rfind(name, 0) == 0) examples.push_back(line.substr(std::string(name).size()));
    }
  }
  const auto hexadecimal = [](const std::vector<std::uint8_t>& bytes) {
    std::ostringstream text;
    text << std::hex << std::uppercase;
    for (const std::uint8_t byte : bytes) {
      if (text.tellp() > 0) text << ' ';
      text << (byte < 16 ? "0" : "") << static_cast<int>(byte);
    }
    return text.str();
  };
  ASSERT_EQ(examples.size(), 3u);
  EXPECT_EQ(examples[0], hexadecimal(frameOf(serial::Hello{kDriveVersion})));
  EXPECT_EQ(examples[1],
            hexadecimal(frameOf(DriveIdentity{kDriveVersion, 258, 1234567, kContactors})));
  EXPECT_EQ(examples[2], hexadecimal(frameOf(DriveState{41, true}, 7)));
}

}  // namespace
}  // namespace haptex::tactile::test_drive_protocol
