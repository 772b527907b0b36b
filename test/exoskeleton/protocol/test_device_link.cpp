#include <gtest/gtest.h>

#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "serial_fixtures.h"

namespace haptex::exoskeleton::test_device_link {
namespace {

const Identity kDevice{kProtocolVersion, 3, 77, kCountsPerRevolution};

void receive(DeviceLink& link, const ByteVector& bytes, Time now) {
  link.receive(bytes.data(), bytes.size(), now);
}

DeviceLink connectedAt(Time now) {
  DeviceLink link;
  link.poll(now);
  receive(link, frameOf(kDevice), now);
  return link;
}

TEST(DeviceLink, GreetsUntilTheDeviceAnswers) {
  DeviceLink link;
  EXPECT_EQ(link.status(), LinkStatus::kConnecting);
  EXPECT_EQ(copy(link.poll(milliseconds(7))), frameOf(Hello{kProtocolVersion}));
  EXPECT_TRUE(link.poll(milliseconds(8)).empty());
  EXPECT_TRUE(link.poll(milliseconds(106)).empty());
  EXPECT_EQ(copy(link.poll(milliseconds(107))), frameOf(Hello{kProtocolVersion}));
  receive(link, frameOf(kDevice), milliseconds(108));
  EXPECT_EQ(link.status(), LinkStatus::kConnected);
  EXPECT_EQ(link.identity().firmware, 3);
  EXPECT_EQ(link.identity().serial_number, 77u);
  EXPECT_EQ(link.statistics().handshakes, 1u);
  EXPECT_TRUE(link.poll(milliseconds(109)).empty());
}

TEST(DeviceLink, SendsNoCommandBeforeTheHandshake) {
  DeviceLink link;
  EXPECT_TRUE(link.send(commandOf(DriveMode::kForce, 1)).empty());
  EXPECT_EQ(link.lastCommand(), 0);
  receive(link, frameOf(kDevice), milliseconds(1));
  const DeviceCommand command = commandOf(DriveMode::kForce, 1);
  EXPECT_EQ(copy(link.send(command)), frameOf(command, 1));
  EXPECT_EQ(copy(link.send(command)), frameOf(command, 2));
  EXPECT_EQ(link.lastCommand(), 2);
}

TEST(DeviceLink, HandsOutEveryStateOnceAndOnlyTheNewest) {
  DeviceLink link = connectedAt(milliseconds(0));
  EXPECT_EQ(link.takeState(), nullptr);
  ByteVector bytes = frameOf(stateAt(1000), 1);
  append(bytes, frameOf(stateAt(2000), 2));
  receive(link, bytes, milliseconds(2));
  const DeviceState* state = link.takeState();
  ASSERT_NE(state, nullptr);
  EXPECT_EQ(state->time, 2000u);
  EXPECT_EQ(link.takeState(), nullptr);
  EXPECT_EQ(link.statistics().lost_states, 0u);
  EXPECT_EQ(link.statistics().received.good_frames, 3u);
}

TEST(DeviceLink, IgnoresStatesBeforeTheHandshake) {
  DeviceLink link;
  receive(link, frameOf(stateAt(1), 1), milliseconds(0));
  EXPECT_EQ(link.takeState(), nullptr);
  EXPECT_EQ(link.status(), LinkStatus::kConnecting);
}

TEST(DeviceLink, DropsAndCountsRepeatedAndLateStates) {
  DeviceLink link = connectedAt(milliseconds(0));
  std::vector<std::uint32_t> taken;
  for (const std::uint8_t number : {1, 2, 4, 3, 4, 5}) {
    receive(link, frameOf(stateAt(number), number), milliseconds(number));
    const DeviceState* state = link.takeState();
    if (state != nullptr) taken.push_back(state->time);
  }
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{1, 2, 4, 5}));
  EXPECT_EQ(link.statistics().repeated_states, 2u);
  EXPECT_EQ(link.statistics().lost_states, 1u);
}

TEST(DeviceLink, CountsGapsAcrossTheWrapOfTheNumbers) {
  DeviceLink link;
  receive(link, frameOf(kDevice, 249), milliseconds(0));
  receive(link, frameOf(stateAt(1), 250), milliseconds(1));
  EXPECT_EQ(link.statistics().lost_states, 0u);
  receive(link, frameOf(stateAt(2), 4), milliseconds(2));
  EXPECT_EQ(link.statistics().lost_states, 9u);
  receive(link, frameOf(stateAt(3), 5), milliseconds(3));
  EXPECT_EQ(link.statistics().lost_states, 9u);
}

TEST(DeviceLink, TimesOutAfterTwentyMillisecondsWithoutANewState) {
  DeviceLink link = connectedAt(milliseconds(0));
  receive(link, frameOf(stateAt(1), 1), milliseconds(200));
  link.poll(milliseconds(219));
  EXPECT_EQ(link.status(), LinkStatus::kConnected);
  receive(link, frameOf(stateAt(1), 1), milliseconds(219));  // the same again is no life sign
  EXPECT_EQ(copy(link.poll(milliseconds(220))), frameOf(Hello{kProtocolVersion}));
  EXPECT_EQ(link.status(), LinkStatus::kTimedOut);
  EXPECT_EQ(link.statistics().timeouts, 1u);
  EXPECT_TRUE(link.send(commandOf(DriveMode::kForce, 1)).empty());
  EXPECT_EQ(link.takeState(), nullptr);
  link.poll(milliseconds(221));
  EXPECT_EQ(link.statistics().timeouts, 1u);
}

TEST(DeviceLink, RecoversByItselfAfterATimeout) {
  DeviceLink link = connectedAt(milliseconds(0));
  link.send(commandOf(DriveMode::kForce, 1));
  EXPECT_EQ(copy(link.poll(milliseconds(150))), frameOf(Hello{kProtocolVersion}, 1));
  receive(link, frameOf(stateAt(5), 5), milliseconds(151));  // not before the handshake
  EXPECT_EQ(link.status(), LinkStatus::kTimedOut);
  EXPECT_EQ(link.takeState(), nullptr);
  receive(link, frameOf(kDevice, 6), milliseconds(152));
  receive(link, frameOf(stateAt(7), 7), milliseconds(153));
  EXPECT_EQ(link.status(), LinkStatus::kConnected);
  ASSERT_NE(link.takeState(), nullptr);
  EXPECT_EQ(link.statistics().handshakes, 2u);
  EXPECT_EQ(link.statistics().lost_states, 0u);
  EXPECT_EQ(copy(link.send(DeviceCommand{})), frameOf(DeviceCommand{}, 2));
}

TEST(DeviceLink, TellsTheVersionOfADeviceThatSpeaksAnother) {
  DeviceLink link;
  link.poll(milliseconds(0));
  receive(link, frameOf(Identity{7, 1, 1, 1}), milliseconds(1));
  EXPECT_EQ(link.status(), LinkStatus::kVersionMismatch);
  EXPECT_EQ(link.identity().version, 7);
  EXPECT_EQ(link.statistics().version_mismatches, 1u);
  EXPECT_TRUE(link.send(DeviceCommand{}).empty());
  EXPECT_TRUE(link.poll(milliseconds(99)).empty());
  EXPECT_EQ(copy(link.poll(milliseconds(100))), frameOf(Hello{kProtocolVersion}));
  receive(link, frameOf(kDevice), milliseconds(101));  // its firmware was exchanged
  EXPECT_EQ(link.status(), LinkStatus::kConnected);
  EXPECT_EQ(link.identity().version, kProtocolVersion);
}

TEST(DeviceLink, CorruptionIsCountedAndIsNoTimeout) {
  DeviceLink link = connectedAt(milliseconds(0));
  ByteVector bad = frameOf(stateAt(1), 1);
  bad[20] ^= 4;
  receive(link, bad, milliseconds(1));
  receive(link, frameOf(stateAt(2), 2), milliseconds(2));
  link.poll(milliseconds(2));
  EXPECT_EQ(link.status(), LinkStatus::kConnected);
  EXPECT_EQ(link.statistics().received.corrupt_frames, 1u);
  EXPECT_EQ(link.statistics().lost_states, 1u);
  EXPECT_EQ(link.takeState()->time, 2u);
}

TEST(DeviceLink, NothingButCorruptStatesEndsInATimeout) {
  DeviceLink link = connectedAt(milliseconds(0));
  for (std::uint8_t i = 1; i <= 20; ++i) {
    ByteVector bad = frameOf(stateAt(i), i);
    bad[20] ^= 4;
    receive(link, bad, milliseconds(i));
    link.poll(milliseconds(i));
  }
  EXPECT_EQ(link.status(), LinkStatus::kTimedOut);
  EXPECT_EQ(link.statistics().received.corrupt_frames, 20u);
}

TEST(DeviceLink, FramesWithFieldsWithoutMeaningAreCountedAndDropped) {
  DeviceLink link;
  receive(link, frameOf(Identity{kProtocolVersion, 1, 1, 0}), milliseconds(0));
  EXPECT_EQ(link.status(), LinkStatus::kConnecting);
  receive(link, frameOf(kDevice), milliseconds(0));
  DeviceState state = stateAt(1);
  state.mode = static_cast<DriveMode>(9);
  receive(link, frameOf(state, 1), milliseconds(1));
  EXPECT_EQ(link.takeState(), nullptr);
  EXPECT_EQ(link.statistics().meaningless_frames, 2u);
}

TEST(DeviceLink, StartsOverWhenThePortIsOpenedAnew) {
  DeviceLink link = connectedAt(milliseconds(0));
  receive(link, frameOf(stateAt(1), 1), milliseconds(1));
  ByteVector start = frameOf(stateAt(2), 2);
  start.resize(30);
  receive(link, start, milliseconds(2));
  link.reset();
  EXPECT_EQ(link.status(), LinkStatus::kConnecting);
  EXPECT_EQ(link.takeState(), nullptr);
  EXPECT_TRUE(link.send(DeviceCommand{}).empty());
  EXPECT_EQ(copy(link.poll(milliseconds(3))), frameOf(Hello{kProtocolVersion}));
  EXPECT_EQ(link.statistics().timeouts, 0u);
}

TEST(DeviceLink, AFrameThatWasInterruptedForAsLongAsATimeoutIsDropped) {
  DeviceLink link = connectedAt(milliseconds(0));
  const ByteVector state = frameOf(stateAt(1), 1);
  link.receive(state.data(), 30, milliseconds(1));
  link.receive(state.data() + 30, 20, milliseconds(11));
  EXPECT_EQ(link.takeState(), nullptr);
  link.receive(state.data(), 30, milliseconds(12));
  link.receive(state.data() + 30, 20, milliseconds(21));
  EXPECT_NE(link.takeState(), nullptr);
}

TEST(DeviceLink, SpeaksWithADevice) {
  DeviceLink link;
  FirmwareModel device(kDevice);
  for (int i = 0; i < 1000; ++i) {
    const Time now = milliseconds(i);
    const auto to_device = [&](Bytes bytes) { device.receive(bytes.data, bytes.size, now); };
    const auto to_link = [&](Bytes bytes) { link.receive(bytes.data, bytes.size, now); };
    to_device(link.poll(now));
    to_device(link.send(commandOf(DriveMode::kForce, 700)));
    to_link(device.answer());
    to_link(device.report(stateAt(static_cast<std::uint32_t>(i)), now));
    const DeviceState* state = link.takeState();
    ASSERT_NE(state, nullptr) << i;
    EXPECT_EQ(state->time, static_cast<std::uint32_t>(i));
    EXPECT_EQ(state->last_command, link.lastCommand());
    const bool whole = equal(device.command(now), commandOf(DriveMode::kForce, 700));
    EXPECT_EQ(whole, i >= 6) << i;  // the device takes five milliseconds to let torques come
  }
  EXPECT_EQ(link.statistics().handshakes, 1u);
  EXPECT_EQ(link.statistics().lost_states, 0u);
  EXPECT_EQ(link.statistics().repeated_states, 0u);
}

TEST(DeviceLink, DescribesEveryStatusDifferently) {
  const LinkStatus all[] = {LinkStatus::kConnecting, LinkStatus::kConnected, LinkStatus::kTimedOut,
                            LinkStatus::kVersionMismatch};
  for (const LinkStatus a : all) {
    for (const LinkStatus b : all) {
      EXPECT_EQ(std::string(describe(a)) == describe(b), a == b);
    }
  }
}

}  // namespace
}  // namespace haptex::exoskeleton::test_device_link
