// What driver and drive electronics of the contactors tell each other, as values and as frames of
// the serial line. docs/tactile_protocol.md has the bytes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/serial/device_link.h"
#include "haptex/serial/frame.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::tactile {

/// Version of the protocol, exchanged in the handshake. Those of the exoskeleton count from 1,
/// these from 129: on the other one's port each finds another version, and is obeyed by neither.
constexpr std::uint8_t kDriveVersion = 129;

/// Amplitudes of the drive of an array, shares of full drive: 0 to 1, of both channels together.
using ArrayDrive = PerContactor<PerChannel<double>>;

/// Steps of a transmitted share.
constexpr double kDriveStep = 1.0 / 65535.0;

/// From one command to the next, and from one state to the next.
constexpr base::Time kDrivePeriod = std::chrono::milliseconds(5);

/// The answer to Hello. States follow it and no command is obeyed before it.
struct DriveIdentity {
  std::uint8_t version = kDriveVersion;
  std::uint16_t firmware = 0;             ///< number of the firmware, no unit
  std::uint32_t serial_number = 0;        ///< no unit
  std::uint8_t contactors = kContactors;  ///< of each finger
};

/// From the electronics, once per kDrivePeriod.
struct DriveState {
  std::uint8_t last_command = 0;  ///< sequence number of the last command obeyed
  bool watchdog_tripped = false;  ///< commands stopped while contactors moved; until the next one
};

/// To the electronics, once per kDrivePeriod.
struct DriveCommand {
  base::PerFinger<ArrayDrive> drive;  ///< to be reached along a straight line in kDrivePeriod
};

/// Bytes of a command's payload: for both fingers, two for each channel of each contactor.
constexpr int kDriveCommandPayload = 2 * kContactors * 2 * kChannels;

constexpr serial::FrameLayout kDriveLayout{kDriveVersion, 8, 2, kDriveCommandPayload};

/// Writes a frame into the buffer. Shares outside of 0 to 1 saturate, what is not finite becomes
/// zero, and of 320 Hz no more is left than 40 Hz leaves of full drive.
/// @returns the part of the buffer that it fills
serial::Bytes encode(const DriveIdentity& identity, std::uint8_t sequence,
                     serial::FrameBuffer& buffer);
serial::Bytes encode(const DriveState& state, std::uint8_t sequence, serial::FrameBuffer& buffer);
serial::Bytes encode(const DriveCommand& command, std::uint8_t sequence,
                     serial::FrameBuffer& buffer);

/// Nothing if the frame is of another type or length or a field has no meaning: other contactors
/// than kContactors, an unknown flag, channels of a contactor that are beyond full drive together.
/// Of an Identity of another version only the version is known, all else is zero.
std::optional<DriveIdentity> decodeDriveIdentity(const serial::Frame& frame);
std::optional<DriveState> decodeDriveState(const serial::Frame& frame);
std::optional<DriveCommand> decodeDriveCommand(const serial::Frame& frame);

/// What serial::DeviceLink has to know of it.
struct DriveProtocol {
  using Identity = DriveIdentity;
  using State = DriveState;
  using Command = DriveCommand;

  static constexpr serial::FrameLayout kLayout = kDriveLayout;
  static constexpr base::Time kStateTimeout = 6 * kDrivePeriod;

  static Identity unknownIdentity() { return {0, 0, 0, 0}; }
  static std::optional<Identity> decodeIdentity(const serial::Frame& frame) {
    return decodeDriveIdentity(frame);
  }
  static std::optional<State> decodeState(const serial::Frame& frame) {
    return decodeDriveState(frame);
  }
  static serial::Bytes encode(const Command& command, std::uint8_t sequence,
                              serial::FrameBuffer& buffer) {
    return tactile::encode(command, sequence, buffer);
  }
};

using DriveLink = serial::DeviceLink<DriveProtocol>;

}  // namespace haptex::tactile
