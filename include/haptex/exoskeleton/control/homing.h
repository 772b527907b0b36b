// Finds the stops of one finger's joints, because incremental encoders do not know where they are.
#pragma once

#include <array>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// Moves all three joints slowly to their lower stops, a little off them and onto them again, while
/// the person relaxes the finger. The coupled joint follows. What it finds is plausible if no joint
/// turns further than its range, each leaves its stop when it is told to, and comes back to the
/// same place.
///
/// The motors' speeds are held by a proportional-integral controller whose torque is bounded, so
/// that it ends as that torque on a stop. Not thread-safe, does not allocate.
class Homing {
 public:
  /// N m on the motor axis. Twice what gravity and friction of the links take (about 0.7 mN m), and
  /// behind the reduction of 14 at most 0.5 N at a fingertip 0.04 m from the joint, 0.2 N at
  /// 0.09 m.
  static constexpr double kTorque = 1.4e-3;
  static constexpr double kSpeed = 14.0;  ///< rad/s of a motor, 1 rad/s of a joint
  static constexpr Time kRest = std::chrono::milliseconds(100);  ///< standing still on a stop
  static constexpr Time kTimeout = std::chrono::seconds(10);
  /// rad of a motor. Standing still is moving less than this, one count and a bit.
  static constexpr double kStill = 0.004;
  /// rad of a motor by which each has to leave its stop: 10 counts, 0.2 mm at the fingertip.
  static constexpr double kBackOff = 0.03;
  /// rad of a motor by which the two stops found may differ: 4 counts, 0.05 degrees of a joint.
  static constexpr double kSamePlace = 0.0125;
  /// rad of a motor by which a joint may turn further than its range: 3 degrees of the joint.
  static constexpr double kBeyondRange = 0.73;

  enum class Status {
    kIdle,
    kRunning,
    kDone,           ///< the motors are at their lower stops now
    kNoRest,         ///< culprit() found no rest within kTimeout
    kTurnedTooFar,   ///< culprit() turned further than its range: its transmission slips
    kStuck,          ///< culprit() did not leave its stop: jammed, or its encoder is dead
    kDifferentPlace  ///< culprit() came back to another place
  };

  /// @param range rad, that each motor can turn
  void start(const MotorVector& range, Time now);

  /// One period while running. @param angles rad @param velocities rad/s, of the motors
  /// @returns N m, what the motors are to do; zero unless running
  MotorVector tick(const MotorVector& angles, const MotorVector& velocities, Time now);

  Status status() const { return status_; }
  /// Motor, and thus joint, that failed; -1 if none did.
  int culprit() const { return culprit_; }

 private:
  enum class Phase { kApproach, kLeave, kReturn };

  MotorVector drive(double speed, const MotorVector& velocities, double dt);
  bool atRest(const MotorVector& angles, Time now);
  void enter(Phase phase, const MotorVector& angles, Time now);
  void fail(Status status, int motor);

  Status status_ = Status::kIdle;
  Phase phase_ = Phase::kApproach;
  int culprit_ = -1;
  bool first_tick_ = true;
  MotorVector range_ = MotorVector::Zero();
  MotorVector highest_ = MotorVector::Zero();  ///< angles reached since start()
  MotorVector stops_ = MotorVector::Zero();    ///< of the first approach
  MotorVector integral_ = MotorVector::Zero();
  MotorVector torques_ = MotorVector::Zero();
  MotorVector still_at_ = MotorVector::Zero();  ///< where each motor began to stand still
  std::array<Time, kMotors> still_since_{};
  Time start_{0};
  Time last_tick_{0};
};

}  // namespace haptex::exoskeleton
