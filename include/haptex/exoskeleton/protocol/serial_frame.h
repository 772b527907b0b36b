// Frames of the serial line: how messages become bytes and bytes messages. The layout of the bytes
// is in serial_frame.cpp and nowhere else; docs/serial_protocol.md draws it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/exoskeleton/protocol/bytes.h"
#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {

enum class FrameType : std::uint8_t { kHello = 1, kIdentity = 2, kState = 3, kCommand = 4 };

/// Which end of the line reads: a driver takes Identity and State, a device Hello and Command.
enum class LineEnd { kDriver, kDevice };

/// Bytes of a State, the longest frame, and of one without its payload.
constexpr std::size_t kLongestFrame = 50;
constexpr std::size_t kFrameOverhead = 7;

using FrameBuffer = std::array<std::uint8_t, kLongestFrame>;

/// A frame whose checksum was right, in bytes that somebody else owns.
struct Frame {
  FrameType type = FrameType::kHello;
  std::uint8_t sequence = 0;
  Bytes payload;
  Bytes bytes;  ///< all of it, from the first sync byte to the checksum
};

/// Writes a frame into the buffer. @returns the part of the buffer that it fills
/// Numbers beyond the range of their encoding saturate, and a force component that does sets
/// force_saturated. What is not finite becomes zero, in a force with force_saturated.
Bytes encode(const Hello& hello, std::uint8_t sequence, FrameBuffer& buffer);
Bytes encode(const Identity& identity, std::uint8_t sequence, FrameBuffer& buffer);
Bytes encode(const DeviceState& state, std::uint8_t sequence, FrameBuffer& buffer);
Bytes encode(const DeviceCommand& command, std::uint8_t sequence, FrameBuffer& buffer);

/// Nothing if the frame is of another type or length or a field has no meaning. Every number is
/// finite: the bytes are integers. Of a Hello or Identity of another version than kProtocolVersion
/// only the version is known, all else is zero.
std::optional<Hello> decodeHello(const Frame& frame);
std::optional<Identity> decodeIdentity(const Frame& frame);
std::optional<DeviceState> decodeState(const Frame& frame);
std::optional<DeviceCommand> decodeCommand(const Frame& frame);

enum class FrameVerdict {
  kUnfinished,        ///< may become a good frame
  kNoSync,            ///< does not begin with the sync bytes
  kImpossibleLength,  ///< the length is not one of the type
  kUnknownType,       ///< no type, or none that this end takes
  kCorrupt,           ///< the checksum is wrong
  kGood,
};

struct Inspection {
  FrameVerdict verdict = FrameVerdict::kNoSync;
  /// If unfinished: how long the bytes have to be at least to know more. If good: of the frame.
  std::size_t size = 0;
  Frame frame;  ///< if good
};

/// What the bytes begin with. Decides as early as the bytes allow: random bytes are hardly ever
/// waited for.
Inspection inspect(Bytes bytes, LineEnd end);

/// The same frame as a device or driver of another version would send it: in the handshake the
/// version, else the seed of the checksum. For tests and FaultInjector. @returns the part of the
/// buffer that it fills; the unchanged bytes if they are not a good frame
Bytes inVersion(Bytes frame, std::uint8_t version, FrameBuffer& buffer);

/// The first bytes of a Command whose length is beyond the longest frame. For tests and
/// FaultInjector. @param payload its length, above kLongestFrame
Bytes oversizeStart(std::uint8_t payload, std::uint8_t sequence, FrameBuffer& buffer);

/// CRC-16 with polynomial 0x1021, most significant bit first, not inverted, starting from
/// 0xFFFF xor (0x0101 x version). "123456789" in version 0 gives 0x29B1 (CRC-16/CCITT-FALSE).
std::uint16_t checksum(Bytes bytes, std::uint8_t version);

/// Numbers up to this far behind the last one are old, all others are ahead. 32 ms are longer than
/// anything comes late, and short enough that after a long gap hardly any number looks old.
constexpr std::uint8_t kOldNumbers = 32;

/// By how much a sequence number is ahead of the last one, modulo 256: 1 if none was lost, 0 if it
/// is not new (the same, or up to kOldNumbers behind).
constexpr int numbersAhead(std::uint8_t number, std::uint8_t last) {
  const auto ahead = static_cast<std::uint8_t>(number - last);
  return ahead < 256 - kOldNumbers ? ahead : 0;
}

}  // namespace haptex::exoskeleton
