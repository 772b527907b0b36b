// Frames of a serial line: sync, length, type, sequence number, payload and checksum, whatever the
// protocol whose messages they carry. docs/serial_protocol.md draws them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/serial/bytes.h"

namespace haptex::serial {

enum class FrameType : std::uint8_t { kHello = 1, kIdentity = 2, kState = 3, kCommand = 4 };

/// Which end of the line reads: a driver takes Identity and State, a device Hello and Command.
enum class LineEnd { kDriver, kDevice };

/// Both ends have to understand the handshake whatever their versions, so its checksum has a
/// version of its own that no protocol has.
constexpr std::uint8_t kHandshakeVersion = 0;
/// Bytes of a Hello's payload, the version, and of a frame without its payload.
constexpr std::size_t kHelloPayload = 1;
constexpr std::size_t kFrameOverhead = 7;
/// Bytes of the longest frame that any protocol can have.
constexpr std::size_t kFrameCapacity = kFrameOverhead + 255;

using FrameBuffer = std::array<std::uint8_t, kFrameCapacity>;

/// By what the frames of one protocol differ from those of another.
struct FrameLayout {
  /// Of the protocol, not kHandshakeVersion. The checksum of states and commands is seeded with it:
  /// those of another version, and of another protocol, are never taken for ours.
  std::uint8_t version;
  std::uint8_t identity_payload;  ///< bytes, and so are the next
  std::uint8_t state_payload;
  std::uint8_t command_payload;

  constexpr std::size_t longestPayload() const {
    return std::max({identity_payload, state_payload, command_payload});
  }
};

/// A frame whose checksum was right, in bytes that somebody else owns.
struct Frame {
  FrameType type = FrameType::kHello;
  std::uint8_t sequence = 0;
  Bytes payload;
  Bytes bytes;  ///< all of it, from the first sync byte to the checksum
};

/// Asks a device who it is.
struct Hello {
  std::uint8_t version;
};

/// Writes little-endian integers one after the other into a frame.
class FrameWriter {
 public:
  /// @param payload bytes that will be put
  FrameWriter(FrameBuffer& buffer, FrameType type, std::uint8_t sequence, std::size_t payload);

  /// The lowest `bytes` bytes of the value.
  void put(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      buffer_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }

  /// Puts the checksum. @returns the part of the buffer that the frame fills
  Bytes finish(std::uint8_t version);

  Bytes written() const { return {buffer_.data(), size_}; }

 private:
  FrameBuffer& buffer_;
  std::size_t size_ = 0;
};

/// Reads what FrameWriter writes; the caller has checked the length.
class PayloadReader {
 public:
  explicit PayloadReader(Bytes bytes) : next_(bytes.data) {}

  template <typename Integer>
  Integer get() {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      value |= static_cast<std::uint64_t>(*next_++) << (8 * i);
    }
    return static_cast<Integer>(value);
  }

 private:
  const std::uint8_t* next_;
};

/// @returns the part of the buffer that it fills
Bytes encode(const Hello& hello, std::uint8_t sequence, FrameBuffer& buffer);

/// Nothing if the frame is of another type or length.
std::optional<Hello> decodeHello(const Frame& frame);

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
/// waited for. An Identity, which may be of another version, may be of any length up to the
/// longest.
Inspection inspect(Bytes bytes, LineEnd end, const FrameLayout& layout);

/// The same frame as a device or driver of another version would send it: in the handshake the
/// version, else the seed of the checksum. For tests and FaultInjector. @returns the part of the
/// buffer that it fills; the unchanged bytes if they are not a good frame
Bytes inVersion(Bytes frame, std::uint8_t version, const FrameLayout& layout, FrameBuffer& buffer);

/// The first bytes of a Command whose length is beyond the longest frame. For tests and
/// FaultInjector. @param payload its length, above the longest payload
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

}  // namespace haptex::serial
