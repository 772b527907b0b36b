#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "haptex/serial/serial_port.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_serial_frame {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The definition, bit by bit.
std::uint16_t slowChecksum(const ByteVector& bytes, unsigned start) {
  unsigned remainder = start;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool carry = ((remainder >> 15) ^ (byte >> bit)) & 1;
      remainder = ((remainder << 1) & 0xFFFF) ^ (carry ? 0x1021 : 0);
    }
  }
  return static_cast<std::uint16_t>(remainder);
}

TEST(SerialFrame, ChecksumIsThePublishedOne) {
  const std::string digits = "123456789";
  const ByteVector bytes(digits.begin(), digits.end());
  EXPECT_EQ(checksum(view(bytes), 0), 0x29B1);
  EXPECT_EQ(checksum(view(bytes), 0), slowChecksum(bytes, 0xFFFF));
  EXPECT_EQ(checksum(view(bytes), 1), slowChecksum(bytes, 0xFEFE));
  EXPECT_EQ(checksum(view(bytes), 0x5A), slowChecksum(bytes, 0xA5A5));
}

// The lines "name: A5 5A ..." of docs/serial_protocol.md.
ByteVector documented(const std::string& name) {
  std::ifstream file(HAPTEX_SOURCE_DIRECTORY "/docs/serial_protocol.md");
  std::string line;
  while (std::getline(file, line)) {
    if (line.rfind("    " + name + ": ", 0) != 0) continue;
    std::istringstream numbers(line.substr(name.size() + 6));
    ByteVector bytes;
    for (unsigned byte = 0; numbers >> std::hex >> byte;) {
      bytes.push_back(static_cast<std::uint8_t>(byte));
    }
    return bytes;
  }
  return {};
}

TEST(SerialFrame, TheExamplesOfTheDocumentAreTheBytes) {
  EXPECT_EQ(documented("Hello"), frameOf(Hello{kProtocolVersion}, 0));
  EXPECT_EQ(documented("Identity"), frameOf(Identity{kProtocolVersion, 0x0102, 1234567, 2048}, 0));
  DeviceState state;
  state.time = 1000000;
  state.last_command = 41;
  state.mode = DriveMode::kForce;
  state.fingers[Finger::kIndex] = {{1, -1, 1000}, {0.5, 0.0, -1.25}, false};
  state.fingers[Finger::kThumb] = {{70000, -70000, 0}, {0.0, 40.0, 0.001}, false};
  EXPECT_EQ(documented("State"), frameOf(state, 7));
  DeviceCommand command;
  command.mode = DriveMode::kForce;
  command.torques[Finger::kIndex] = {0.01, -0.01, 0.0};
  command.torques[Finger::kThumb] = {kTorqueStep, 1.0, -1.0};
  EXPECT_EQ(documented("Command"), frameOf(command, 42));
}

TEST(SerialFrame, AMillisecondHoldsAStateAt921600BaudAndNotAtHalfOfIt) {
  EXPECT_EQ(frameOf(Hello{kProtocolVersion}).size(), 8u);
  EXPECT_EQ(frameOf(Identity{}).size(), 16u);
  EXPECT_EQ(frameOf(DeviceState{}).size(), kLongestFrame);
  EXPECT_EQ(frameOf(DeviceCommand{}).size(), 20u);
  const double bits = 10.0 * kLongestFrame;  // a start and a stop bit each
  EXPECT_LT(bits / serial::kBaudRate, 0.6e-3);
  EXPECT_GT(bits / (0.5 * serial::kBaudRate), 1e-3);
}

TEST(SerialFrame, EveryMessageComesBackAsItWasSent) {
  std::mt19937 generator(1);
  for (int i = 0; i < 1000; ++i) {
    const DeviceState state = randomState(generator);
    const ByteVector state_bytes = frameOf(state, static_cast<std::uint8_t>(i));
    const Frame frame = frameIn(state_bytes, LineEnd::kDriver);
    EXPECT_EQ(frame.sequence, i % 256);
    const auto decoded = decodeState(frame);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->time, state.time);
    EXPECT_EQ(decoded->last_command, state.last_command);
    EXPECT_EQ(decoded->mode, state.mode);
    EXPECT_EQ(decoded->watchdog_tripped, state.watchdog_tripped);
    for (const Finger finger : kFingers) {
      EXPECT_EQ(decoded->fingers[finger].encoder_counts, state.fingers[finger].encoder_counts);
      EXPECT_EQ(decoded->fingers[finger].force, state.fingers[finger].force);
      EXPECT_EQ(decoded->fingers[finger].force_saturated, state.fingers[finger].force_saturated);
    }
    const DeviceCommand command = randomCommand(generator);
    const ByteVector command_bytes = frameOf(command);
    const auto obeyed = decodeCommand(frameIn(command_bytes, LineEnd::kDevice));
    ASSERT_TRUE(obeyed);
    EXPECT_TRUE(equal(*obeyed, command));
  }
  const ByteVector bytes = frameOf(Identity{kProtocolVersion, 513, 4000000000u, 65535}, 9);
  const auto identity = decodeIdentity(frameIn(bytes, LineEnd::kDriver));
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->version, kProtocolVersion);
  EXPECT_EQ(identity->firmware, 513);
  EXPECT_EQ(identity->serial_number, 4000000000u);
  EXPECT_EQ(identity->counts_per_revolution, 65535);
}

DeviceCommand sent(const DeviceCommand& command) {
  const ByteVector bytes = frameOf(command);
  return decodeCommand(frameIn(bytes, LineEnd::kDevice)).value();
}

DeviceState sent(const DeviceState& state) {
  const ByteVector bytes = frameOf(state);
  return decodeState(frameIn(bytes, LineEnd::kDriver)).value();
}

TEST(SerialFrame, RoundsToTheNearestStep) {
  DeviceCommand command;
  command.torques[Finger::kThumb] = {2.4 * kTorqueStep, 2.6 * kTorqueStep, -2.6 * kTorqueStep};
  EXPECT_EQ(sent(command).torques[Finger::kThumb],
            MotorVector(2 * kTorqueStep, 3 * kTorqueStep, -3 * kTorqueStep));
}

TEST(SerialFrame, TorquesBeyondTheRangeSaturate) {
  DeviceCommand command;
  const double most = 32767 * kTorqueStep, least = -32768 * kTorqueStep;
  command.torques[Finger::kIndex] = {0.1, -0.1, 1e300};
  EXPECT_EQ(sent(command).torques[Finger::kIndex], MotorVector(most, least, most));
}

TEST(SerialFrame, TorquesThatAreNotFiniteAreNone) {
  for (const double bad : {kNotANumber, kInfinity, -kInfinity}) {
    DeviceCommand command = commandOf(DriveMode::kForce, 100);
    command.torques[Finger::kIndex][1] = bad;
    const DeviceCommand received = sent(command);
    EXPECT_EQ(received.torques[Finger::kIndex],
              MotorVector(100 * kTorqueStep, 0.0, 102 * kTorqueStep));
    EXPECT_EQ(received.torques[Finger::kThumb], command.torques[Finger::kThumb]);
  }
}

TEST(SerialFrame, AForceBeyondTheRangeOrNotFiniteIsMarkedSaturated) {
  DeviceState state;
  state.fingers[Finger::kIndex].force = {32.767, -32.768, 0.0};
  EXPECT_FALSE(sent(state).fingers[Finger::kIndex].force_saturated);
  state.fingers[Finger::kIndex].force = {0.0, 32.768, -100.0};
  EXPECT_TRUE(sent(state).fingers[Finger::kIndex].force_saturated);
  EXPECT_FALSE(sent(state).fingers[Finger::kThumb].force_saturated);
  EXPECT_TRUE(sent(state).fingers[Finger::kIndex].force.isApprox(
      Eigen::Vector3d(0.0, 32.767, -32.768), 1e-15));
  for (const double bad : {kNotANumber, kInfinity, -kInfinity}) {
    state = {};
    state.fingers[Finger::kThumb].force = {1.0, bad, 2.0};
    EXPECT_TRUE(sent(state).fingers[Finger::kThumb].force_saturated);
    EXPECT_FALSE(sent(state).fingers[Finger::kIndex].force_saturated);
    EXPECT_EQ(sent(state).fingers[Finger::kThumb].force, Eigen::Vector3d(1.0, 0.0, 2.0));
  }
}

TEST(SerialFrame, DecodersRefuseOtherTypesAndLengths) {
  const ByteVector hello = frameOf(Hello{kProtocolVersion}), identity = frameOf(Identity{});
  const ByteVector state = frameOf(DeviceState{}), command = frameOf(DeviceCommand{});
  for (const ByteVector* bytes : {&hello, &identity, &state, &command}) {
    const bool to_device = bytes == &hello || bytes == &command;
    Frame frame = frameIn(*bytes, to_device ? LineEnd::kDevice : LineEnd::kDriver);
    EXPECT_EQ(decodeHello(frame).has_value(), bytes == &hello);
    EXPECT_EQ(decodeIdentity(frame).has_value(), bytes == &identity);
    EXPECT_EQ(decodeState(frame).has_value(), bytes == &state);
    EXPECT_EQ(decodeCommand(frame).has_value(), bytes == &command);
    --frame.payload.size;
    EXPECT_FALSE(decodeHello(frame) || decodeIdentity(frame) || decodeState(frame) ||
                 decodeCommand(frame));
  }
}

TEST(SerialFrame, DecodersRefuseFieldsWithoutMeaning) {
  ByteVector command = frameOf(DeviceCommand{});
  command[5] = 3;  // mode
  seal(command);
  EXPECT_EQ(inspect(view(command), LineEnd::kDevice, kFrameLayout).verdict,
            serial::FrameVerdict::kGood);
  EXPECT_FALSE(decodeCommand(frameIn(command, LineEnd::kDevice)));

  ByteVector state = frameOf(DeviceState{});
  state[10] = 255;  // mode
  seal(state);
  EXPECT_EQ(inspect(view(state), LineEnd::kDriver, kFrameLayout).verdict,
            serial::FrameVerdict::kGood);
  EXPECT_FALSE(decodeState(frameIn(state, LineEnd::kDriver)));

  for (int bit = 0; bit < 8; ++bit) {
    state = frameOf(DeviceState{});
    state[11] = static_cast<std::uint8_t>(1 << bit);  // flags
    seal(state);
    EXPECT_EQ(decodeState(frameIn(state, LineEnd::kDriver)).has_value(), bit < 3) << bit;
  }
  const ByteVector identity = frameOf(Identity{kProtocolVersion, 1, 1, 0});
  EXPECT_EQ(inspect(view(identity), LineEnd::kDriver, kFrameLayout).verdict,
            serial::FrameVerdict::kGood);
  EXPECT_FALSE(decodeIdentity(frameIn(identity, LineEnd::kDriver)));
}

TEST(SerialFrame, AHandshakeOfAnotherVersionTellsTheVersionWhateverItsLength) {
  const ByteVector hello = frameOf(Hello{7});
  ASSERT_TRUE(decodeHello(frameIn(hello, LineEnd::kDevice)));
  EXPECT_EQ(decodeHello(frameIn(hello, LineEnd::kDevice))->version, 7);
  for (const std::uint8_t payload : {1, 5, 9, 30, 43}) {
    ByteVector identity = {0xA5, 0x5A, payload, 2, 0, 7};
    identity.resize(serial::kFrameOverhead + payload, 0xEE);
    seal(identity, 0);
    ASSERT_EQ(inspect(view(identity), LineEnd::kDriver, kFrameLayout).verdict,
              serial::FrameVerdict::kGood);
    const auto decoded = decodeIdentity(frameIn(identity, LineEnd::kDriver));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->version, 7);
    EXPECT_EQ(decoded->firmware, 0);
    EXPECT_EQ(decoded->serial_number, 0u);
  }
}

TEST(SerialFrame, NoFrameOfAnotherVersionIsTakenForOurs) {
  std::mt19937 generator(2);
  FrameBuffer buffer;
  for (int version = 0; version < 256; ++version) {
    const bool ours = version == kProtocolVersion;
    const auto expected = ours ? serial::FrameVerdict::kGood : serial::FrameVerdict::kCorrupt;
    const ByteVector state = frameOf(randomState(generator));
    const ByteVector command = frameOf(randomCommand(generator));
    const auto other = static_cast<std::uint8_t>(version);
    EXPECT_EQ(inspect(serial::inVersion(view(state), other, kFrameLayout, buffer), LineEnd::kDriver,
                      kFrameLayout)
                  .verdict,
              expected);
    EXPECT_EQ(inspect(serial::inVersion(view(command), other, kFrameLayout, buffer),
                      LineEnd::kDevice, kFrameLayout)
                  .verdict,
              expected);
  }
  const ByteVector identity = frameOf(Identity{});
  const serial::Inspection other = inspect(
      serial::inVersion(view(identity), 9, kFrameLayout, buffer), LineEnd::kDriver, kFrameLayout);
  ASSERT_EQ(other.verdict, serial::FrameVerdict::kGood);
  EXPECT_EQ(decodeIdentity(other.frame)->version, 9);
}

TEST(SerialFrame, BytesThatAreNoFrameHaveNoOtherVersion) {
  const ByteVector bytes = {1, 2, 3};
  FrameBuffer buffer;
  EXPECT_EQ(copy(serial::inVersion(view(bytes), 9, kFrameLayout, buffer)), bytes);
}

// Of a polynomial with 0x1021 over less than 32752 bits, whatever the data: Koopman and
// Chakravarty, Cyclic redundancy code (CRC) polynomial selection for embedded networks, 2004.
TEST(SerialFrame, EveryDamageOfUpToThreeBitsIsFound) {
  const ByteVector good = frameOf(commandOf(DriveMode::kForce, 1234), 99);
  const std::size_t bits = 8 * good.size();
  ByteVector damaged = good;
  const auto flip = [&](std::size_t bit) {
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
  };
  const auto taken = [&] {
    return inspect(view(damaged), LineEnd::kDevice, kFrameLayout).verdict ==
           serial::FrameVerdict::kGood;
  };
  long wrong = 0;
  for (std::size_t i = 0; i < bits; ++i) {
    flip(i);
    wrong += taken();
    for (std::size_t j = i + 1; j < bits; ++j) {
      flip(j);
      wrong += taken();
      for (std::size_t k = j + 1; k < bits; ++k) {
        flip(k);
        wrong += taken();
        flip(k);
      }
      flip(j);
    }
    flip(i);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(taken());
}

TEST(SerialFrame, DecidesAsEarlyAsTheBytesAllow) {
  const auto verdict = [](const ByteVector& bytes) {
    return inspect(view(bytes), LineEnd::kDriver, kFrameLayout).verdict;
  };
  EXPECT_EQ(verdict({}), serial::FrameVerdict::kUnfinished);
  EXPECT_EQ(verdict({0x5A}), serial::FrameVerdict::kNoSync);
  EXPECT_EQ(verdict({0xA5}), serial::FrameVerdict::kUnfinished);
  EXPECT_EQ(verdict({0xA5, 0xA5}), serial::FrameVerdict::kNoSync);
  EXPECT_EQ(verdict({0xA5, 0x5A, 44}), serial::FrameVerdict::kImpossibleLength);
  EXPECT_EQ(verdict({0xA5, 0x5A, 43}), serial::FrameVerdict::kUnfinished);
  EXPECT_EQ(verdict({0xA5, 0x5A, 43, 3}), serial::FrameVerdict::kUnfinished);
  EXPECT_EQ(verdict({0xA5, 0x5A, 42, 3}), serial::FrameVerdict::kImpossibleLength);
  EXPECT_EQ(verdict({0xA5, 0x5A, 0, 2}), serial::FrameVerdict::kImpossibleLength);
  EXPECT_EQ(verdict({0xA5, 0x5A, 43, 5}), serial::FrameVerdict::kUnknownType);
  EXPECT_EQ(verdict({0xA5, 0x5A, 1, 1}), serial::FrameVerdict::kUnknownType);  // Hello to a driver
  EXPECT_EQ(verdict({0xA5, 0x5A, 13, 4}),
            serial::FrameVerdict::kUnknownType);  // Command to a driver
  const auto to_device = [](const ByteVector& bytes) {
    return inspect(view(bytes), LineEnd::kDevice, kFrameLayout).verdict;
  };
  EXPECT_EQ(to_device({0xA5, 0x5A, 43, 3}), serial::FrameVerdict::kUnknownType);
  EXPECT_EQ(to_device({0xA5, 0x5A, 9, 2}), serial::FrameVerdict::kUnknownType);
  EXPECT_EQ(to_device({0xA5, 0x5A, 2, 1}), serial::FrameVerdict::kImpossibleLength);
  EXPECT_EQ(to_device({0xA5, 0x5A, 12, 4}), serial::FrameVerdict::kImpossibleLength);
  EXPECT_EQ(to_device({0xA5, 0x5A, 13, 4}), serial::FrameVerdict::kUnfinished);
}

TEST(SerialFrame, SequenceNumbersGoRoundAndLateOnesAreOld) {
  EXPECT_EQ(serial::numbersAhead(8, 7), 1);
  EXPECT_EQ(serial::numbersAhead(0, 255), 1);
  EXPECT_EQ(serial::numbersAhead(4, 250), 10);
  EXPECT_EQ(serial::numbersAhead(7, 7), 0);
  EXPECT_EQ(serial::numbersAhead(6, 7), 0);
  EXPECT_EQ(serial::numbersAhead(250, 4), 0);
  EXPECT_EQ(serial::numbersAhead(100 - serial::kOldNumbers, 100), 0);
  EXPECT_EQ(serial::numbersAhead(100 - serial::kOldNumbers - 1, 100), 255 - serial::kOldNumbers);
}

}  // namespace
}  // namespace haptex::exoskeleton::test_serial_frame
