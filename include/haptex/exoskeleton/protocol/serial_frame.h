// How the exoskeleton's messages become frames of the serial line and frames messages. The layout
// of their payloads is in serial_frame.cpp and nowhere else; docs/serial_protocol.md draws it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/exoskeleton/protocol/device_messages.h"
#include "haptex/serial/frame.h"

namespace haptex::exoskeleton {

using serial::Bytes;
using serial::Frame;
using serial::FrameBuffer;
using serial::FrameType;
using serial::Hello;
using serial::LineEnd;

constexpr serial::FrameLayout kFrameLayout{kProtocolVersion, 9, 43, 13};

/// Bytes of a State, the longest frame.
constexpr std::size_t kLongestFrame = serial::kFrameOverhead + kFrameLayout.longestPayload();

/// Writes a frame into the buffer. Numbers beyond the range of their encoding saturate, and a force
/// component that does sets force_saturated. What is not finite becomes zero, in a force with
/// force_saturated.
/// @returns the part of the buffer that it fills
Bytes encode(const Identity& identity, std::uint8_t sequence, FrameBuffer& buffer);
Bytes encode(const DeviceState& state, std::uint8_t sequence, FrameBuffer& buffer);
Bytes encode(const DeviceCommand& command, std::uint8_t sequence, FrameBuffer& buffer);

/// Nothing if the frame is of another type or length or a field has no meaning. Every number is
/// finite: the bytes are integers. Of an Identity of another version than kProtocolVersion
/// only the version is known, all else is zero.
std::optional<Identity> decodeIdentity(const Frame& frame);
std::optional<DeviceState> decodeState(const Frame& frame);
std::optional<DeviceCommand> decodeCommand(const Frame& frame);

}  // namespace haptex::exoskeleton
