// The motors' angles and velocities from their incremental encoders.
#pragma once

#include <array>
#include <cstdint>

#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {

/// Encoders of one finger. Their counts wrap around at 32 bits and start anywhere.
///
/// Velocities are first differences through two equal low-pass filters of first order at
/// kVelocityBandwidth, discretised exactly for whatever period the states have. At 1 kHz each
/// filter is 2.2 ms late and the difference half a period, 4.9 ms together. A single count, which
/// the difference alone would show as 3 rad/s for 1 ms, makes at most 2 pi 60 Hz / e * 3.07 mrad =
/// 0.43 rad/s of the motor, 3 mm/s at a fingertip 0.1 m from the joint.
///
/// Not thread-safe, does not allocate.
class MotorEncoders {
 public:
  static constexpr double kVelocityBandwidth = 60.0;  ///< Hz
  /// rad/s. 45 rad/s at the joint behind a reduction of 14: three times what tapping fingers reach.
  static constexpr double kMaxSpeed = 630.0;

  /// Takes the counts of a state. @param dt s since those before, > 0; ignored the first time
  /// @returns false if a motor would have turned faster than kMaxSpeed: these are counts of
  ///   another life of the device, or the encoder is broken. Nothing changes then
  bool update(const std::array<std::int32_t, kMotors>& counts, double dt);

  /// From now on the last counts mean these angles (rad).
  void calibrate(const MotorVector& angles);

  /// Forgets counts and velocities, the angles stay: the next update() starts over from there.
  void restart();

  const MotorVector& angles() const { return angles_; }          ///< rad
  const MotorVector& velocities() const { return velocities_; }  ///< rad/s

 private:
  std::array<std::int32_t, kMotors> counts_{};            ///< the last ones
  std::array<std::int64_t, kMotors> since_calibrated_{};  ///< counts
  MotorVector calibrated_at_ = MotorVector::Zero();
  MotorVector angles_ = MotorVector::Zero();
  MotorVector half_filtered_ = MotorVector::Zero();
  MotorVector velocities_ = MotorVector::Zero();
  bool has_counts_ = false;
};

}  // namespace haptex::exoskeleton
