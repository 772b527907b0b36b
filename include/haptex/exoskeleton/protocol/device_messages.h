// What driver and device tell each other, as values. docs/serial_protocol.md has the bytes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// Version of the protocol, exchanged in the handshake. The checksum of states and commands is
/// seeded with it, so that those of another version are never taken for ours; Hello and Identity
/// are readable in every version.
constexpr std::uint8_t kProtocolVersion = 1;

/// Counts of an incremental encoder per revolution of its motor: 512 lines, four edges each.
constexpr int kCountsPerRevolution = 2048;
/// Steps of a transmitted force component (N) and motor torque (N m).
constexpr double kForceStep = 0.001;
constexpr double kTorqueStep = 2.5e-6;

/// What the driver wants from the motors.
enum class DriveMode : std::uint8_t {
  kOff = 0,     ///< no current
  kHoming = 1,  ///< the torques move the device to its stops; the person relaxes the finger
  kForce = 2,   ///< the torques render forces
};

/// The answer to Hello. States follow it and no command is obeyed before it.
struct Identity {
  std::uint8_t version = kProtocolVersion;
  std::uint16_t firmware = 0;       ///< number of the firmware, no unit
  std::uint32_t serial_number = 0;  ///< no unit
  std::uint16_t counts_per_revolution = kCountsPerRevolution;
};

struct FingerReading {
  /// Counts of the motors' incremental encoders since the device was switched on, at whatever
  /// angles it was then.
  std::array<std::int32_t, kMotors> encoder_counts{};
  /// N, by the device on the person's fingertip, in the fingertip's frame (<finger>_tip).
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  /// A component of the force is at the end of the sensor's range.
  bool force_saturated = false;
};

/// From the device, once per millisecond.
struct DeviceState {
  std::uint32_t time = 0;         ///< us of the device's clock, wraps around
  std::uint8_t last_command = 0;  ///< sequence number of the last command obeyed
  DriveMode mode = DriveMode::kOff;
  bool watchdog_tripped = false;  ///< commands stopped while motors were on; until the next command
  PerFinger<FingerReading> fingers;
};

/// To the device, once per millisecond. A device that gets none takes its motors to zero, see
/// firmware_model.h.
struct DeviceCommand {
  DriveMode mode = DriveMode::kOff;
  PerFinger<MotorVector> torques{
      {MotorVector::Zero(), MotorVector::Zero()}};  ///< N m, on the motor axes
};

}  // namespace haptex::exoskeleton
