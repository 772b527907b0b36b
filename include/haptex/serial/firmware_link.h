// The device's end of a serial line, as its firmware does it: answers the handshake, tells which
// commands are to be obeyed, and numbers the states. Does no input or output itself: bytes and time
// are handed in, bytes to be sent are handed out.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "haptex/base/clock.h"
#include "haptex/serial/frame.h"
#include "haptex/serial/frame_parser.h"

namespace haptex::serial {

/// Never allocates.
class FirmwareLink {
 public:
  using Time = base::Time;

  /// The rest of a command that was interrupted for so long may be another driver's.
  static constexpr Time kInterrupted = std::chrono::milliseconds(10);

  /// @param version that the device says of itself: a Hello of another one does not make it obey
  FirmwareLink(std::uint8_t version, const FrameLayout& layout)
      : version_(version), parser_(LineEnd::kDevice, layout) {}

  /// Takes bytes that have arrived. Commands before the first Hello are ignored, and so are those
  /// that are not newer than the last one.
  /// @param obey called as obey(frame, ahead) with every other Command, `ahead` of the last one by
  ///   its number; returns whether the command means something, for only then it counts as obeyed
  template <typename Obey>
  void receive(const std::uint8_t* bytes, std::size_t count, Time now, const Obey& obey);

  /// The identity, if a Hello came since the last call; empty otherwise. Valid until the next call
  /// that returns bytes.
  template <typename Identity>
  Bytes answer(const Identity& identity);

  /// The state as bytes, numbered; empty before the first handshake. Valid likewise.
  template <typename State>
  Bytes report(const State& state);

  /// Sequence number of the last command, or what a Hello since has set: states echo it.
  std::uint8_t lastCommand() const { return command_number_; }
  /// Counts of what came.
  const ParserStatistics& received() const { return parser_.statistics(); }

 private:
  void greet(const Frame& frame);
  /// By how much the number of a command is ahead of the last one, 0 if it is not to be obeyed.
  int commandsAhead(std::uint8_t number) const;

  std::uint8_t version_;
  FrameParser parser_;
  FrameBuffer outgoing_{};
  bool greeted_ = false;  // by a driver of our version
  bool to_answer_ = false;
  std::uint8_t state_number_ = 0;
  std::uint8_t command_number_ = 0;
  bool has_obeyed_ = false;
  std::uint8_t obeyed_number_ = 0;  // of the last command, whatever a Hello has set
  Time last_bytes_{};
};

template <typename Obey>
void FirmwareLink::receive(const std::uint8_t* bytes, std::size_t count, Time now,
                           const Obey& obey) {
  if (count == 0) return;
  // Else the first bytes of a dead driver's last command would wait for something to complete them.
  if (now - last_bytes_ >= kInterrupted) parser_.discard();
  last_bytes_ = now;
  Bytes rest{bytes, count};
  while (const Frame* frame = parser_.next(rest)) {
    if (frame->type == FrameType::kHello) greet(*frame);
    if (frame->type != FrameType::kCommand) continue;
    const int ahead = commandsAhead(frame->sequence);
    if (ahead == 0 || !obey(*frame, ahead)) continue;
    has_obeyed_ = true;
    command_number_ = obeyed_number_ = frame->sequence;
  }
}

template <typename Identity>
Bytes FirmwareLink::answer(const Identity& identity) {
  if (!to_answer_) return {};
  to_answer_ = false;
  return encode(identity, state_number_, outgoing_);
}

template <typename State>
Bytes FirmwareLink::report(const State& state) {
  if (!greeted_) return {};
  return encode(state, ++state_number_, outgoing_);
}

}  // namespace haptex::serial
