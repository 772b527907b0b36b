// The driver's end of the serial line: handshake, states in, commands out. Does no input or output
// itself: bytes and time are handed in, bytes to be sent are handed out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"
#include "haptex/exoskeleton/protocol/frame_parser.h"
#include "haptex/exoskeleton/protocol/serial_frame.h"

namespace haptex::exoskeleton {

enum class LinkStatus {
  kConnecting,       ///< Hello is repeated, no Identity yet
  kConnected,        ///< states arrive
  kTimedOut,         ///< was connected, and no state came for kStateTimeout; Hello is repeated
  kVersionMismatch,  ///< the device answers in another protocol version; Hello is repeated
};

/// In plain words, for diagnostics.
const char* describe(LinkStatus status);

/// Counts since the construction, no units.
struct LinkStatistics {
  ParserStatistics received;             ///< good, corrupt and unknown frames, bytes of garbage
  std::uint64_t meaningless_frames = 0;  ///< the checksum was right, but a field means nothing
  std::uint64_t lost_states = 0;         ///< gaps in the sequence numbers of states
  std::uint64_t repeated_states = 0;     ///< same or older sequence number: duplicated or reordered
  std::uint64_t timeouts = 0;            ///< transitions to kTimedOut
  std::uint64_t version_mismatches = 0;  ///< answers in another version
  std::uint64_t handshakes = 0;          ///< transitions to kConnected
};

/// Never allocates.
class DeviceLink {
 public:
  static constexpr Time kStateTimeout = std::chrono::milliseconds(20);
  /// The rest of a frame that was interrupted for so long is too old to be of use.
  static constexpr Time kInterrupted = std::chrono::milliseconds(10);
  static constexpr Time kHelloPeriod = std::chrono::milliseconds(100);

  /// Takes bytes that have arrived. States that are not newer than the last one are dropped.
  void receive(const std::uint8_t* bytes, std::size_t count, Time now);

  /// The newest state since the last call, or nullptr. Valid until the next receive().
  const DeviceState* takeState();
  /// Whether takeState() would return one.
  bool hasState() const { return state_is_new_; }

  /// What to send now: a Hello if one is due, nothing otherwise. To be called once per tick, also
  /// notices timeouts. Valid until the next call that returns bytes.
  Bytes poll(Time now);

  /// A command as bytes, numbered; empty unless connected.
  Bytes send(const DeviceCommand& command);

  /// The port was closed or opened anew: starts over with a handshake.
  void reset();

  LinkStatus status() const;
  /// Of the device, once connected. After an answer in another version only that version, to be
  /// told beside kProtocolVersion.
  const Identity& identity() const;
  const LinkStatistics& statistics() const;
  /// Sequence number of the last command sent: DeviceState::last_command echoes it.
  std::uint8_t lastCommand() const;

 private:
  void handle(const Frame& frame, Time now);
  void handleIdentity(const Frame& frame, Time now);
  void handleState(const Frame& frame, Time now);

  LinkStatus status_ = LinkStatus::kConnecting;
  Identity identity_{0, 0, 0, 0};
  LinkStatistics statistics_;
  FrameParser parser_{LineEnd::kDriver};
  FrameBuffer outgoing_{};
  std::uint8_t last_command_ = 0;
  DeviceState state_;
  bool state_is_new_ = false;
  std::uint8_t last_state_number_ = 0;
  Time last_state_{};  // or Identity
  Time last_bytes_{};
  std::optional<Time> last_hello_;
};

}  // namespace haptex::exoskeleton
