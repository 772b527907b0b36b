#include "haptex/exoskeleton/protocol/serial_frame.h"

#include <cmath>
#include <limits>

namespace haptex::exoskeleton {
namespace {

// Layout of a frame: sync, length of the payload, type, sequence number, payload, checksum. The
// checksum covers what lies between the sync bytes and itself.
constexpr std::array<std::uint8_t, 2> kSync{0xA5, 0x5A};
constexpr std::size_t kLengthAt = 2, kTypeAt = 3, kSequenceAt = 4, kPayloadAt = 5;
constexpr std::size_t kChecksumSize = 2;
static_assert(kPayloadAt + kChecksumSize == kFrameOverhead);

constexpr std::size_t kHelloPayload = 1, kIdentityPayload = 9, kStatePayload = 43,
                      kCommandPayload = 13;
static_assert(kFrameOverhead + kStatePayload == kLongestFrame);

// Both ends have to understand the handshake whatever their versions, so its checksum has a version
// of its own that no protocol has.
constexpr std::uint8_t kHandshakeVersion = 0;
static_assert(kProtocolVersion != kHandshakeVersion);

// Bits of the flags of a State; the others are zero.
constexpr unsigned kWatchdogFlag = 1, kIndexForceFlag = 2, kThumbForceFlag = 4;
constexpr unsigned kAllFlags = kWatchdogFlag | kIndexForceFlag | kThumbForceFlag;

constexpr unsigned forceFlag(Finger finger) {
  return finger == Finger::kIndex ? kIndexForceFlag : kThumbForceFlag;
}

constexpr bool isHandshake(FrameType type) {
  return type == FrameType::kHello || type == FrameType::kIdentity;
}

constexpr std::uint8_t checksumVersion(FrameType type) {
  return isHandshake(type) ? kHandshakeVersion : kProtocolVersion;
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

// Writes little-endian integers one after the other.
class Writer {
 public:
  Writer(FrameBuffer& buffer, FrameType type, std::uint8_t sequence, std::size_t payload)
      : buffer_(buffer) {
    put(kSync[0], 1);
    put(kSync[1], 1);
    put(payload, 1);
    put(static_cast<std::uint8_t>(type), 1);
    put(sequence, 1);
  }

  void put(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      buffer_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }

  Bytes finish(std::uint8_t version) {
    put(checksum({buffer_.data() + kLengthAt, size_ - kLengthAt}, version), kChecksumSize);
    return written();
  }

  Bytes written() const { return {buffer_.data(), size_}; }

 private:
  FrameBuffer& buffer_;
  std::size_t size_ = 0;
};

// Reads what Writer writes; the caller has checked the length.
class Reader {
 public:
  explicit Reader(Bytes bytes) : next_(bytes.data) {}

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

// An Identity of another version may be of any length up to the longest.
bool possible(std::size_t payload, FrameType type) {
  switch (type) {
    case FrameType::kHello:
      return payload == kHelloPayload;
    case FrameType::kIdentity:
      return payload >= 1 && payload <= kStatePayload;
    case FrameType::kState:
      return payload == kStatePayload;
    case FrameType::kCommand:
      return payload == kCommandPayload;
  }
  return false;
}

std::uint16_t checksumAt(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}

}  // namespace

std::uint16_t checksum(Bytes bytes, std::uint8_t version) {
  unsigned remainder = 0xFFFFu ^ (0x0101u * version);
  for (std::size_t i = 0; i < bytes.size; ++i) {
    remainder = ((remainder << 8) ^ kChecksumTable[(remainder >> 8) ^ bytes.data[i]]) & 0xFFFFu;
  }
  return static_cast<std::uint16_t>(remainder);
}

Bytes encode(const Hello& hello, std::uint8_t sequence, FrameBuffer& buffer) {
  Writer writer(buffer, FrameType::kHello, sequence, kHelloPayload);
  writer.put(hello.version, 1);
  return writer.finish(kHandshakeVersion);
}

Bytes encode(const Identity& identity, std::uint8_t sequence, FrameBuffer& buffer) {
  Writer writer(buffer, FrameType::kIdentity, sequence, kIdentityPayload);
  writer.put(identity.version, 1);
  writer.put(identity.firmware, 2);
  writer.put(identity.serial_number, 4);
  writer.put(identity.counts_per_revolution, 2);
  return writer.finish(kHandshakeVersion);
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
  Writer writer(buffer, FrameType::kState, sequence, kStatePayload);
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
  Writer writer(buffer, FrameType::kCommand, sequence, kCommandPayload);
  writer.put(static_cast<std::uint8_t>(command.mode), 1);
  for (const Finger finger : kFingers) {
    for (int motor = 0; motor < kMotors; ++motor) {
      writer.put(steps(command.torques[finger][motor], kTorqueStep).count, 2);
    }
  }
  return writer.finish(kProtocolVersion);
}

std::optional<Hello> decodeHello(const Frame& frame) {
  if (frame.type != FrameType::kHello || frame.payload.size != kHelloPayload) return {};
  return Hello{frame.payload.data[0]};
}

std::optional<Identity> decodeIdentity(const Frame& frame) {
  if (frame.type != FrameType::kIdentity || frame.payload.empty()) return {};
  Reader reader(frame.payload);
  Identity identity{reader.get<std::uint8_t>(), 0, 0, 0};
  if (identity.version != kProtocolVersion) return identity;
  if (frame.payload.size != kIdentityPayload) return {};
  identity.firmware = reader.get<std::uint16_t>();
  identity.serial_number = reader.get<std::uint32_t>();
  identity.counts_per_revolution = reader.get<std::uint16_t>();
  if (identity.counts_per_revolution == 0) return {};
  return identity;
}

std::optional<DeviceState> decodeState(const Frame& frame) {
  if (frame.type != FrameType::kState || frame.payload.size != kStatePayload) return {};
  Reader reader(frame.payload);
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
  if (frame.type != FrameType::kCommand || frame.payload.size != kCommandPayload) return {};
  Reader reader(frame.payload);
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

Inspection inspect(Bytes bytes, LineEnd end) {
  for (std::size_t i = 0; i < kSync.size() && i < bytes.size; ++i) {
    if (bytes.data[i] != kSync[i]) return {FrameVerdict::kNoSync, 0, {}};
  }
  if (bytes.size > kLengthAt && bytes.data[kLengthAt] > kStatePayload) {
    return {FrameVerdict::kImpossibleLength, 0, {}};
  }
  if (bytes.size <= kTypeAt) return {FrameVerdict::kUnfinished, kTypeAt + 1, {}};
  if (!receives(bytes.data[kTypeAt], end)) return {FrameVerdict::kUnknownType, 0, {}};
  const auto type = static_cast<FrameType>(bytes.data[kTypeAt]);
  const std::size_t payload = bytes.data[kLengthAt];
  if (!possible(payload, type)) return {FrameVerdict::kImpossibleLength, 0, {}};
  const std::size_t size = kFrameOverhead + payload;
  if (bytes.size < size) return {FrameVerdict::kUnfinished, size, {}};
  const std::size_t covered = size - kLengthAt - kChecksumSize;
  if (checksum({bytes.data + kLengthAt, covered}, checksumVersion(type)) !=
      checksumAt(bytes.data + size - kChecksumSize)) {
    return {FrameVerdict::kCorrupt, 0, {}};
  }
  const Frame frame{
      type, bytes.data[kSequenceAt], {bytes.data + kPayloadAt, payload}, {bytes.data, size}};
  return {FrameVerdict::kGood, size, frame};
}

Bytes oversizeStart(std::uint8_t payload, std::uint8_t sequence, FrameBuffer& buffer) {
  return Writer(buffer, FrameType::kCommand, sequence, payload).written();
}

Bytes inVersion(Bytes frame, std::uint8_t version, FrameBuffer& buffer) {
  Inspection found = inspect(frame, LineEnd::kDriver);
  if (found.verdict != FrameVerdict::kGood) found = inspect(frame, LineEnd::kDevice);
  if (found.verdict != FrameVerdict::kGood) return frame;
  const Bytes payload = found.frame.payload;
  const bool handshake = isHandshake(found.frame.type);
  Writer writer(buffer, found.frame.type, found.frame.sequence, payload.size);
  for (std::size_t i = 0; i < payload.size; ++i) {
    writer.put(i == 0 && handshake ? version : payload.data[i], 1);
  }
  return writer.finish(handshake ? kHandshakeVersion : version);
}

}  // namespace haptex::exoskeleton
