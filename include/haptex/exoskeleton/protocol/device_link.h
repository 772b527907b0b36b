// The driver's end of the serial line to the exoskeleton.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"
#include "haptex/exoskeleton/protocol/serial_frame.h"
#include "haptex/serial/device_link.h"

namespace haptex::exoskeleton {

using serial::LinkStatistics;
using serial::LinkStatus;

/// What serial::DeviceLink has to know of it.
struct Protocol {
  using Identity = exoskeleton::Identity;
  using State = DeviceState;
  using Command = DeviceCommand;

  static constexpr serial::FrameLayout kLayout = kFrameLayout;
  static constexpr Time kStateTimeout = std::chrono::milliseconds(20);

  static Identity unknownIdentity() { return {0, 0, 0, 0}; }
  static std::optional<Identity> decodeIdentity(const Frame& frame) {
    return exoskeleton::decodeIdentity(frame);
  }
  static std::optional<State> decodeState(const Frame& frame) {
    return exoskeleton::decodeState(frame);
  }
  static Bytes encode(const Command& command, std::uint8_t sequence, FrameBuffer& buffer) {
    return exoskeleton::encode(command, sequence, buffer);
  }
};

using DeviceLink = serial::DeviceLink<Protocol>;

}  // namespace haptex::exoskeleton
