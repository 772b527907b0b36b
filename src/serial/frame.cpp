#include "haptex/serial/frame.h"

namespace haptex::serial {
namespace {

// Layout of a frame: sync, length of the payload, type, sequence number, payload, checksum. The
// checksum covers what lies between the sync bytes and itself.
constexpr std::array<std::uint8_t, 2> kSync{0xA5, 0x5A};
constexpr std::size_t kLengthAt = 2, kTypeAt = 3, kSequenceAt = 4, kPayloadAt = 5;
constexpr std::size_t kChecksumSize = 2;
static_assert(kPayloadAt + kChecksumSize == kFrameOverhead);

constexpr bool isHandshake(FrameType type) {
  return type == FrameType::kHello || type == FrameType::kIdentity;
}

constexpr std::array<std::uint16_t, 256> checksumTable() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned remainder = byte << 8;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder << 1) ^ ((remainder & 0x8000) != 0 ? 0x1021 : 0);
    }
    table[byte] = static_cast<std::uint16_t>(remainder);
  }
  return table;
}

constexpr std::array<std::uint16_t, 256> kChecksumTable = checksumTable();

bool receives(std::uint8_t type, LineEnd end) {
  switch (static_cast<FrameType>(type)) {
    case FrameType::kHello:
    case FrameType::kCommand:
      return end == LineEnd::kDevice;
    case FrameType::kIdentity:
    case FrameType::kState:
      return end == LineEnd::kDriver;
  }
  return false;
}

bool possible(std::size_t payload, FrameType type, const FrameLayout& layout) {
  switch (type) {
    case FrameType::kHello:
      return payload == kHelloPayload;
    case FrameType::kIdentity:
      return payload >= 1 && payload <= layout.longestPayload();
    case FrameType::kState:
      return payload == layout.state_payload;
    case FrameType::kCommand:
      return payload == layout.command_payload;
  }
  return false;
}

std::uint16_t checksumAt(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}

}  // namespace

FrameWriter::FrameWriter(FrameBuffer& buffer, FrameType type, std::uint8_t sequence,
                         std::size_t payload)
    : buffer_(buffer) {
  put(kSync[0], 1);
  put(kSync[1], 1);
  put(payload, 1);
  put(static_cast<std::uint8_t>(type), 1);
  put(sequence, 1);
}

Bytes FrameWriter::finish(std::uint8_t version) {
  put(checksum({buffer_.data() + kLengthAt, size_ - kLengthAt}, version), kChecksumSize);
  return written();
}

std::uint16_t checksum(Bytes bytes, std::uint8_t version) {
  unsigned remainder = 0xFFFFu ^ (0x0101u * version);
  for (std::size_t i = 0; i < bytes.size; ++i) {
    remainder = ((remainder << 8) ^ kChecksumTable[(remainder >> 8) ^ bytes.data[i]]) & 0xFFFFu;
  }
  return static_cast<std::uint16_t>(remainder);
}

Bytes encode(const Hello& hello, std::uint8_t sequence, FrameBuffer& buffer) {
  FrameWriter writer(buffer, FrameType::kHello, sequence, kHelloPayload);
  writer.put(hello.version, 1);
  return writer.finish(kHandshakeVersion);
}

std::optional<Hello> decodeHello(const Frame& frame) {
  if (frame.type != FrameType::kHello || frame.payload.size != kHelloPayload) return {};
  return Hello{frame.payload.data[0]};
}

Inspection inspect(Bytes bytes, LineEnd end, const FrameLayout& layout) {
  for (std::size_t i = 0; i < kSync.size() && i < bytes.size; ++i) {
    if (bytes.data[i] != kSync[i]) return {FrameVerdict::kNoSync, 0, {}};
  }
  if (bytes.size > kLengthAt && bytes.data[kLengthAt] > layout.longestPayload()) {
    return {FrameVerdict::kImpossibleLength, 0, {}};
  }
  if (bytes.size <= kTypeAt) return {FrameVerdict::kUnfinished, kTypeAt + 1, {}};
  if (!receives(bytes.data[kTypeAt], end)) return {FrameVerdict::kUnknownType, 0, {}};
  const auto type = static_cast<FrameType>(bytes.data[kTypeAt]);
  const std::size_t payload = bytes.data[kLengthAt];
  if (!possible(payload, type, layout)) return {FrameVerdict::kImpossibleLength, 0, {}};
  const std::size_t size = kFrameOverhead + payload;
  if (bytes.size < size) return {FrameVerdict::kUnfinished, size, {}};
  const std::size_t covered = size - kLengthAt - kChecksumSize;
  const std::uint8_t version = isHandshake(type) ? kHandshakeVersion : layout.version;
  if (checksum({bytes.data + kLengthAt, covered}, version) !=
      checksumAt(bytes.data + size - kChecksumSize)) {
    return {FrameVerdict::kCorrupt, 0, {}};
  }
  const Frame frame{
      type, bytes.data[kSequenceAt], {bytes.data + kPayloadAt, payload}, {bytes.data, size}};
  return {FrameVerdict::kGood, size, frame};
}

Bytes oversizeStart(std::uint8_t payload, std::uint8_t sequence, FrameBuffer& buffer) {
  return FrameWriter(buffer, FrameType::kCommand, sequence, payload).written();
}

Bytes inVersion(Bytes frame, std::uint8_t version, const FrameLayout& layout, FrameBuffer& buffer) {
  Inspection found = inspect(frame, LineEnd::kDriver, layout);
  if (found.verdict != FrameVerdict::kGood) found = inspect(frame, LineEnd::kDevice, layout);
  if (found.verdict != FrameVerdict::kGood) return frame;
  const Bytes payload = found.frame.payload;
  const bool handshake = isHandshake(found.frame.type);
  FrameWriter writer(buffer, found.frame.type, found.frame.sequence, payload.size);
  for (std::size_t i = 0; i < payload.size; ++i) {
    writer.put(i == 0 && handshake ? version : payload.data[i], 1);
  }
  return writer.finish(handshake ? kHandshakeVersion : version);
}

}  // namespace haptex::serial
