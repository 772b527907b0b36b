#include "haptex/tactile/drive/drive_protocol.h"

#include <algorithm>
#include <cmath>

namespace haptex::tactile {
namespace {

using base::kFingers;
using serial::Bytes;
using serial::Frame;
using serial::FrameBuffer;
using serial::FrameType;
using serial::FrameWriter;
using serial::PayloadReader;

// Bits of the flags of a State; the others are zero.
constexpr unsigned kWatchdogFlag = 1;

constexpr unsigned kFull = 65535;  // steps

// NaN compares false.
unsigned steps(double share) {
  if (!(share > 0.0) || std::isinf(share)) return 0;
  return share < 1.0 ? static_cast<unsigned>(share / kDriveStep) : kFull;
}

}  // namespace

Bytes encode(const DriveIdentity& identity, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kIdentity, sequence, kDriveLayout.identity_payload);
  writer.put(identity.version, 1);
  writer.put(identity.firmware, 2);
  writer.put(identity.serial_number, 4);
  writer.put(identity.contactors, 1);
  return writer.finish(serial::kHandshakeVersion);
}

Bytes encode(const DriveState& state, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kState, sequence, kDriveLayout.state_payload);
  writer.put(state.last_command, 1);
  writer.put(state.watchdog_tripped ? kWatchdogFlag : 0, 1);
  return writer.finish(kDriveVersion);
}

// Shares are rounded down: what is full drive together stays so.
Bytes encode(const DriveCommand& command, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kCommand, sequence, kDriveLayout.command_payload);
  for (const base::Finger finger : kFingers) {
    for (const PerChannel<double>& shares : command.drive[finger]) {
      const unsigned slow = steps(shares[k40]);
      writer.put(slow, 2);
      writer.put(std::min(steps(shares[k320]), kFull - slow), 2);
    }
  }
  return writer.finish(kDriveVersion);
}

std::optional<DriveIdentity> decodeDriveIdentity(const Frame& frame) {
  if (frame.type != FrameType::kIdentity || frame.payload.empty()) return {};
  PayloadReader reader(frame.payload);
  DriveIdentity identity{reader.get<std::uint8_t>(), 0, 0, 0};
  if (identity.version != kDriveVersion) return identity;
  if (frame.payload.size != kDriveLayout.identity_payload) return {};
  identity.firmware = reader.get<std::uint16_t>();
  identity.serial_number = reader.get<std::uint32_t>();
  identity.contactors = reader.get<std::uint8_t>();
  if (identity.contactors != kContactors) return {};
  return identity;
}

std::optional<DriveState> decodeDriveState(const Frame& frame) {
  if (frame.type != FrameType::kState || frame.payload.size != kDriveLayout.state_payload)
    return {};
  PayloadReader reader(frame.payload);
  DriveState state;
  state.last_command = reader.get<std::uint8_t>();
  const unsigned flags = reader.get<std::uint8_t>();
  if ((flags & ~kWatchdogFlag) != 0) return {};
  state.watchdog_tripped = (flags & kWatchdogFlag) != 0;
  return state;
}

std::optional<DriveCommand> decodeDriveCommand(const Frame& frame) {
  if (frame.type != FrameType::kCommand || frame.payload.size != kDriveLayout.command_payload)
    return {};
  PayloadReader reader(frame.payload);
  DriveCommand command;
  for (const base::Finger finger : kFingers) {
    for (PerChannel<double>& shares : command.drive[finger]) {
      const unsigned slow = reader.get<std::uint16_t>(), fast = reader.get<std::uint16_t>();
      if (slow + fast > kFull) return {};
      shares = {kDriveStep * slow, kDriveStep * fast};
    }
  }
  return command;
}

}  // namespace haptex::tactile
