#include "haptex/exoskeleton/protocol/device_link.h"

namespace haptex::exoskeleton {

const char* describe(LinkStatus status) {
  switch (status) {
    case LinkStatus::kConnecting:
      return "the device has not answered yet";
    case LinkStatus::kConnected:
      return "connected to the device";
    case LinkStatus::kTimedOut:
      return "the device has stopped sending states";
    case LinkStatus::kVersionMismatch:
      return "the device speaks another version of the protocol";
  }
  return "unknown";
}

void DeviceLink::receive(const std::uint8_t* bytes, std::size_t count, Time now) {
  if (count == 0) return;
  if (now - last_bytes_ >= kInterrupted) parser_.discard();
  last_bytes_ = now;
  Bytes rest{bytes, count};
  while (const Frame* frame = parser_.next(rest)) handle(*frame, now);
  statistics_.received = parser_.statistics();
}

void DeviceLink::handle(const Frame& frame, Time now) {
  if (frame.type == FrameType::kIdentity) handleIdentity(frame, now);
  if (frame.type == FrameType::kState) handleState(frame, now);
}

void DeviceLink::handleIdentity(const Frame& frame, Time now) {
  const auto identity = decodeIdentity(frame);
  if (!identity) {
    ++statistics_.meaningless_frames;
    return;
  }
  identity_ = *identity;
  if (identity->version != kProtocolVersion) {
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

void DeviceLink::handleState(const Frame& frame, Time now) {
  if (status_ != LinkStatus::kConnected) return;
  const auto state = decodeState(frame);
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

const DeviceState* DeviceLink::takeState() {
  if (!state_is_new_) return nullptr;
  state_is_new_ = false;
  return &state_;
}

Bytes DeviceLink::poll(Time now) {
  if (status_ == LinkStatus::kConnected) {
    if (now - last_state_ < kStateTimeout) return {};
    status_ = LinkStatus::kTimedOut;
    state_is_new_ = false;
    ++statistics_.timeouts;
  }
  if (last_hello_ && now - *last_hello_ < kHelloPeriod) return {};
  last_hello_ = now;
  return encode(Hello{}, last_command_, outgoing_);
}

Bytes DeviceLink::send(const DeviceCommand& command) {
  if (status_ != LinkStatus::kConnected) return {};
  return encode(command, ++last_command_, outgoing_);
}

void DeviceLink::reset() {
  status_ = LinkStatus::kConnecting;
  identity_ = {0, 0, 0, 0};
  parser_.discard();
  state_is_new_ = false;
  last_hello_.reset();
}

LinkStatus DeviceLink::status() const { return status_; }

const Identity& DeviceLink::identity() const { return identity_; }

const LinkStatistics& DeviceLink::statistics() const { return statistics_; }

std::uint8_t DeviceLink::lastCommand() const { return last_command_; }

}  // namespace haptex::exoskeleton
