// The device's end of the serial line, as its firmware does it: answers the handshake, obeys
// commands, reports states, and takes the motors to zero when commands stop. Does no input or
// output itself.
#pragma once

#include <cstddef>
#include <cstdint>

#include "haptex/exoskeleton/clock.h"
#include "haptex/exoskeleton/device_messages.h"
#include "haptex/exoskeleton/frame_parser.h"
#include "haptex/exoskeleton/serial_frame.h"

namespace haptex::exoskeleton {

/// The firmware's command watchdog: from kRampStart to kMotorsOff after the last command the
/// torques go to zero in a straight line, so that the force neither jumps nor outlives a dead
/// driver.
class DeviceEnd {
 public:
  static constexpr Time kRampStart = std::chrono::milliseconds(5);
  static constexpr Time kMotorsOff = std::chrono::milliseconds(10);

  explicit DeviceEnd(const Identity& identity);

  void receive(const std::uint8_t* bytes, std::size_t count, Time now);

  /// Identity, if a Hello came since the last call; empty otherwise.
  Bytes answer();

  /// What the motors are to do now: the last command, scaled by the watchdog.
  DeviceCommand command(Time now);

  /// A state as bytes, numbered; empty before the first handshake. Fills in last_command, mode and
  /// watchdog_tripped.
  Bytes report(DeviceState state, Time now);
};

}  // namespace haptex::exoskeleton
