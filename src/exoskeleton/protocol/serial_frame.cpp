#include "haptex/exoskeleton/protocol/serial_frame.h"

#include <array>
#include <cmath>
#include <limits>

namespace haptex::exoskeleton {
namespace {

using serial::FrameWriter;
using serial::PayloadReader;

// Bits of the flags of a State; the others are zero.
constexpr unsigned kWatchdogFlag = 1, kIndexForceFlag = 2, kThumbForceFlag = 4;
constexpr unsigned kAllFlags = kWatchdogFlag | kIndexForceFlag | kThumbForceFlag;

constexpr unsigned forceFlag(Finger finger) {
  return finger == Finger::kIndex ? kIndexForceFlag : kThumbForceFlag;
}

struct Steps {
  std::int16_t count = 0;
  bool saturated = false;
};

Steps steps(double value, double step) {
  if (!std::isfinite(value)) return {0, true};
  using Range = std::numeric_limits<std::int16_t>;
  const double rounded = std::round(value / step);
  if (rounded > Range::max()) return {Range::max(), true};
  if (rounded < Range::min()) return {Range::min(), true};
  return {static_cast<std::int16_t>(rounded), false};
}

std::optional<DriveMode> driveMode(std::uint8_t byte) {
  switch (static_cast<DriveMode>(byte)) {
    case DriveMode::kOff:
    case DriveMode::kHoming:
    case DriveMode::kForce:
      return static_cast<DriveMode>(byte);
  }
  return {};
}

}  // namespace

Bytes encode(const Identity& identity, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kIdentity, sequence, kFrameLayout.identity_payload);
  writer.put(identity.version, 1);
  writer.put(identity.firmware, 2);
  writer.put(identity.serial_number, 4);
  writer.put(identity.counts_per_revolution, 2);
  return writer.finish(serial::kHandshakeVersion);
}

Bytes encode(const DeviceState& state, std::uint8_t sequence, FrameBuffer& buffer) {
  unsigned flags = state.watchdog_tripped ? kWatchdogFlag : 0;
  PerFinger<std::array<std::int16_t, 3>> forces;
  for (const Finger finger : kFingers) {
    bool saturated = state.fingers[finger].force_saturated;
    for (int axis = 0; axis < 3; ++axis) {
      const Steps force = steps(state.fingers[finger].force[axis], kForceStep);
      forces[finger][axis] = force.count;
      saturated = saturated || force.saturated;
    }
    if (saturated) flags |= forceFlag(finger);
  }
  FrameWriter writer(buffer, FrameType::kState, sequence, kFrameLayout.state_payload);
  writer.put(state.time, 4);
  writer.put(state.last_command, 1);
  writer.put(static_cast<std::uint8_t>(state.mode), 1);
  writer.put(flags, 1);
  for (const Finger finger : kFingers) {
    for (const std::int32_t count : state.fingers[finger].encoder_counts) writer.put(count, 4);
    for (const std::int16_t force : forces[finger]) writer.put(force, 2);
  }
  return writer.finish(kProtocolVersion);
}

Bytes encode(const DeviceCommand& command, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kCommand, sequence, kFrameLayout.command_payload);
  writer.put(static_cast<std::uint8_t>(command.mode), 1);
  for (const Finger finger : kFingers) {
    for (int motor = 0; motor < kMotors; ++motor) {
      writer.put(steps(command.torques[finger][motor], kTorqueStep).count, 2);
    }
  }
  return writer.finish(kProtocolVersion);
}

std::optional<Identity> decodeIdentity(const Frame& frame) {
  if (frame.type != FrameType::kIdentity || frame.payload.empty()) return {};
  PayloadReader reader(frame.payload);
  Identity identity{reader.get<std::uint8_t>(), 0, 0, 0};
  if (identity.version != kProtocolVersion) return identity;
  if (frame.payload.size != kFrameLayout.identity_payload) return {};
  identity.firmware = reader.get<std::uint16_t>();
  identity.serial_number = reader.get<std::uint32_t>();
  identity.counts_per_revolution = reader.get<std::uint16_t>();
  if (identity.counts_per_revolution == 0) return {};
  return identity;
}

std::optional<DeviceState> decodeState(const Frame& frame) {
  if (frame.type != FrameType::kState || frame.payload.size != kFrameLayout.state_payload)
    return {};
  PayloadReader reader(frame.payload);
  DeviceState state;
  state.time = reader.get<std::uint32_t>();
  state.last_command = reader.get<std::uint8_t>();
  const auto mode = driveMode(reader.get<std::uint8_t>());
  const unsigned flags = reader.get<std::uint8_t>();
  if (!mode || (flags & ~kAllFlags) != 0) return {};
  state.mode = *mode;
  state.watchdog_tripped = (flags & kWatchdogFlag) != 0;
  for (const Finger finger : kFingers) {
    FingerReading& reading = state.fingers[finger];
    for (std::int32_t& count : reading.encoder_counts) count = reader.get<std::int32_t>();
    for (int axis = 0; axis < 3; ++axis) {
      reading.force[axis] = kForceStep * reader.get<std::int16_t>();
    }
    reading.force_saturated = (flags & forceFlag(finger)) != 0;
  }
  return state;
}

std::optional<DeviceCommand> decodeCommand(const Frame& frame) {
  if (frame.type != FrameType::kCommand || frame.payload.size != kFrameLayout.command_payload)
    return {};
  PayloadReader reader(frame.payload);
  DeviceCommand command;
  const auto mode = driveMode(reader.get<std::uint8_t>());
  if (!mode) return {};
  command.mode = *mode;
  for (const Finger finger : kFingers) {
    for (int motor = 0; motor < kMotors; ++motor) {
      command.torques[finger][motor] = kTorqueStep * reader.get<std::int16_t>();
    }
  }
  return command;
}

}  // namespace haptex::exoskeleton
