// The device's end of the serial line, as its firmware does it: answers the handshake, obeys
// commands, reports states, and takes the motors to zero when commands stop. Does no input or
// output itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"
#include "haptex/exoskeleton/protocol/serial_frame.h"
#include "haptex/serial/firmware_link.h"

namespace haptex::exoskeleton {

/// The firmware's command watchdog: the torques of the last command are held until kRampStart after
/// it, so that a driver or a line that stands still for a moment does not open the hand, and go to
/// zero in a straight line until kMotorsOff: the force neither jumps nor outlives a driver that has
/// fallen silent by more than 20 ms, of which a command spends up to 0.3 ms on the line. Where the
/// line itself tells that the driver's end was closed (hangUp()) the ramp begins at once. When
/// commands come again the torques come back within kReturn at the soonest: a delayed line does not
/// jerk the fingers either.
///
/// The driver limits how much the force changes from one command to the next. Where commands got
/// lost, or several come at once, the torques go to the last one in a straight line that takes as
/// long as the driver took, and after the watchdog kReturn for the share that it had taken.
class FirmwareModel {
 public:
  static constexpr Time kRampStart = std::chrono::microseconds(14000);
  static constexpr Time kMotorsOff = std::chrono::microseconds(19000);
  static constexpr Time kRamp = kMotorsOff - kRampStart;
  static constexpr Time kReturn = std::chrono::milliseconds(20);

  /// From one command to the next.
  static constexpr Time kCommandPeriod = std::chrono::milliseconds(1);

  explicit FirmwareModel(const Identity& identity);

  /// Takes bytes that have arrived. Commands before the first Hello are ignored, and so are those
  /// that are not newer than the last one. A Hello does not touch the motors: after a driver has
  /// died and a new one greets, the watchdog takes the old torques to zero as if it had not.
  void receive(const std::uint8_t* bytes, std::size_t count, Time now);

  /// The driver's end of the line is closed: DTR has dropped, or nobody has the pseudo-terminal
  /// open. The motors are off kRamp later, unless a command comes.
  void hangUp(Time now);

  /// Identity, if a Hello came since the last call; empty otherwise.
  /// Valid until the next call that returns bytes.
  Bytes answer();

  /// What the motors are to do now: the last command, scaled by the watchdog.
  DeviceCommand command(Time now);

  /// A state as bytes, numbered; empty before the first handshake. Fills in last_command, mode and
  /// watchdog_tripped.
  Bytes report(DeviceState state, Time now);

  /// Counts of what came.
  const serial::ParserStatistics& received() const { return link_.received(); }

 private:
  /// @returns whether the command means something
  bool obey(const Frame& frame, int ahead, Time now);
  void approach(const DeviceCommand& command, int ahead, Time now);
  /// Share of the torques that the watchdog leaves, 0 to 1.
  double watchdogShare(Time now) const;
  /// The watchdog has switched the motors off, or no command has come yet.
  bool isOff(Time now) const;
  /// How far the line to the last command has come: it stops where the watchdog starts.
  Time lineEnd(Time now) const;
  /// The torques of the last command, or on the way to them, times the watchdog's share.
  PerFinger<MotorVector> torques(Time now) const;

  Identity identity_;
  serial::FirmwareLink link_{identity_.version, kFrameLayout};
  DeviceCommand command_;
  PerFinger<MotorVector> from_{{MotorVector::Zero(), MotorVector::Zero()}};  // when command_ came
  Time reached_{};                    // when the torques of command_ are
  std::optional<Time> last_command_;  // when command_ came
  Time ramp_start_{};                 // of the watchdog
};

}  // namespace haptex::exoskeleton
