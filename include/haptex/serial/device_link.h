// The driver's end of a serial line: handshake, states in, commands out. Does no input or output
// itself: bytes and time are handed in, bytes to be sent are handed out.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/base/clock.h"
#include "haptex/serial/frame.h"
#include "haptex/serial/frame_parser.h"
#include "haptex/serial/link_status.h"

namespace haptex::serial {

/// Never allocates.
/// @tparam Protocol has the types Identity (with `version`), State and Command, the constants
///   kLayout and kStateTimeout, and the functions unknownIdentity(), decodeIdentity(),
///   decodeState() and encode()
template <typename Protocol>
class DeviceLink {
 public:
  using Time = base::Time;
  using Identity = typename Protocol::Identity;
  using State = typename Protocol::State;
  using Command = typename Protocol::Command;

  static constexpr Time kStateTimeout = Protocol::kStateTimeout;
  /// The rest of a frame that was interrupted for so long is too old to be of use.
  static constexpr Time kInterrupted = std::chrono::milliseconds(10);
  static constexpr Time kHelloPeriod = std::chrono::milliseconds(100);

  /// Takes bytes that have arrived. States that are not newer than the last one are dropped.
  void receive(const std::uint8_t* bytes, std::size_t count, Time now);

  /// The newest state since the last call, or nullptr. Valid until the next receive().
  const State* takeState();
  /// Whether takeState() would return one.
  bool hasState() const { return state_is_new_; }

  /// What to send now: a Hello if one is due, nothing otherwise. To be called once per tick, also
  /// notices timeouts. Valid until the next call that returns bytes.
  Bytes poll(Time now);

  /// A command as bytes, numbered; empty unless connected.
  Bytes send(const Command& command);

  /// The port was closed or opened anew: starts over with a handshake.
  void reset();

  LinkStatus status() const { return status_; }
  /// Of the device, once connected. After an answer in another version only that version, to be
  /// told beside the own one.
  const Identity& identity() const { return identity_; }
  const LinkStatistics& statistics() const { return statistics_; }
  /// Sequence number of the last command sent: the device's states echo it.
  std::uint8_t lastCommand() const { return last_command_; }

 private:
  void handle(const Frame& frame, Time now);
  void handleIdentity(const Frame& frame, Time now);
  void handleState(const Frame& frame, Time now);

  LinkStatus status_ = LinkStatus::kConnecting;
  Identity identity_ = Protocol::unknownIdentity();
  LinkStatistics statistics_;
  FrameParser parser_{LineEnd::kDriver, Protocol::kLayout};
  FrameBuffer outgoing_{};
  std::uint8_t last_command_ = 0;
  State state_{};
  bool state_is_new_ = false;
  std::uint8_t last_state_number_ = 0;
  Time last_state_{};  // or Identity
  Time last_bytes_{};
  std::optional<Time> last_hello_;
};

template <typename Protocol>
void DeviceLink<Protocol>::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  if (count == 0) return;
  if (now - last_bytes_ >= kInterrupted) parser_.discard();
  last_bytes_ = now;
  Bytes rest{bytes, count};
  while (const Frame* frame = parser_.next(rest)) handle(*frame, now);
  statistics_.received = parser_.statistics();
}

template <typename Protocol>
void DeviceLink<Protocol>::handle(const Frame& frame, Time now) {
  if (frame.type == FrameType::kIdentity) handleIdentity(frame, now);
  if (frame.type == FrameType::kState) handleState(frame, now);
}

template <typename Protocol>
void DeviceLink<Protocol>::handleIdentity(const Frame& frame, Time now) {
  const auto identity = Protocol::decodeIdentity(frame);
  if (!identity) {
    ++statistics_.meaningless_frames;
    return;
  }
  identity_ = *identity;
  if (identity->version != Protocol::kLayout.version) {
    ++statistics_.version_mismatches;
    status_ = LinkStatus::kVersionMismatch;
    state_is_new_ = false;
    return;
  }
  if (status_ == LinkStatus::kConnected) return;
  status_ = LinkStatus::kConnected;
  ++statistics_.handshakes;
  last_state_number_ = frame.sequence;
  last_state_ = now;
}

template <typename Protocol>
void DeviceLink<Protocol>::handleState(const Frame& frame, Time now) {
  if (status_ != LinkStatus::kConnected) return;
  const auto state = Protocol::decodeState(frame);
  if (!state) {
    ++statistics_.meaningless_frames;
    return;
  }
  const int ahead = numbersAhead(frame.sequence, last_state_number_);
  if (ahead == 0) {
    ++statistics_.repeated_states;
    return;
  }
  statistics_.lost_states += ahead - 1;
  last_state_number_ = frame.sequence;
  state_ = *state;
  state_is_new_ = true;
  last_state_ = now;
}

template <typename Protocol>
auto DeviceLink<Protocol>::takeState() -> const State* {
  if (!state_is_new_) return nullptr;
  state_is_new_ = false;
  return &state_;
}

template <typename Protocol>
Bytes DeviceLink<Protocol>::poll(Time now) {
  if (status_ == LinkStatus::kConnected) {
    if (now - last_state_ < kStateTimeout) return {};
    status_ = LinkStatus::kTimedOut;
    state_is_new_ = false;
    ++statistics_.timeouts;
  }
  if (last_hello_ && now - *last_hello_ < kHelloPeriod) return {};
  last_hello_ = now;
  return encode(Hello{Protocol::kLayout.version}, last_command_, outgoing_);
}

template <typename Protocol>
Bytes DeviceLink<Protocol>::send(const Command& command) {
  if (status_ != LinkStatus::kConnected) return {};
  return Protocol::encode(command, ++last_command_, outgoing_);
}

template <typename Protocol>
void DeviceLink<Protocol>::reset() {
  status_ = LinkStatus::kConnecting;
  identity_ = Protocol::unknownIdentity();
  parser_.discard();
  state_is_new_ = false;
  last_hello_.reset();
}

}  // namespace haptex::serial
