// The electronics' end of the serial line, as their firmware does it: answers the handshake, obeys
// commands, reports states, and takes the contactors to zero when commands stop. Does no input or
// output itself.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/serial/firmware_link.h"
#include "haptex/serial/frame.h"
#include "haptex/serial/frame_parser.h"
#include "haptex/tactile/drive/drive_protocol.h"

namespace haptex::tactile {

/// Amplitudes go to those of a command along a straight line of kDrivePeriod, whatever they are
/// when it comes: neither lost, late nor doubled commands make the waveform jump. Its own
/// oscillators run on, so no phase depends on the line. The watchdog holds the last command until
/// kRampStart after it, which bridges a lost one, and takes the amplitudes to zero in a straight
/// line until kSilent. Where the line itself tells that the driver's end was closed (hangUp()) that
/// line begins at once.
class DriveFirmware {
 public:
  using Time = base::Time;

  static constexpr Time kRampStart = std::chrono::milliseconds(14);
  static constexpr Time kSilent = std::chrono::milliseconds(19);
  static constexpr Time kRamp = kSilent - kRampStart;

  explicit DriveFirmware(const DriveIdentity& identity) : identity_(identity) {}

  /// Takes bytes that have arrived. Commands before the first Hello are ignored, and so are those
  /// that are not newer than the last one.
  void receive(const std::uint8_t* bytes, std::size_t count, Time now);

  /// Nobody has the driver's end of the line open. The contactors rest kRamp later.
  void hangUp(Time now);

  /// Identity, if a Hello came since the last call; empty otherwise. Valid until the next call that
  /// returns bytes.
  serial::Bytes answer() { return link_.answer(identity_); }

  /// A state as bytes, numbered; empty before the first handshake.
  serial::Bytes report(Time now);

  /// Amplitudes of the drive now.
  base::PerFinger<ArrayDrive> drive(Time now) const;
  /// Of one contactor. @param now not before the last command
  PerChannel<double> drive(base::Finger finger, int contactor, Time now) const;

  /// The watchdog has taken what moved to zero, until the next command.
  bool watchdogTripped(Time now) const { return moving_ && now >= ramp_start_ + kRamp; }

  /// Counts of what came, and of the commands that were obeyed.
  const serial::ParserStatistics& received() const { return link_.received(); }
  std::uint64_t obeyed() const { return obeyed_; }
  /// The last one that was obeyed; all zero before.
  const DriveCommand& command() const { return command_; }

 private:
  /// @returns whether the command means something
  bool obey(const serial::Frame& frame, Time now);

  DriveIdentity identity_;
  serial::FirmwareLink link_{identity_.version, kDriveLayout};
  base::PerFinger<ArrayDrive> from_{};  // when the last command came
  DriveCommand command_{};
  std::optional<Time> last_command_;  // when it came
  Time ramp_start_{};                 // of the watchdog
  bool moving_ = false;               // by the last command
  std::uint64_t obeyed_ = 0;
};

}  // namespace haptex::tactile
