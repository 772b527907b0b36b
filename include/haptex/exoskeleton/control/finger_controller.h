// What DeviceController does for one finger.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "haptex/exoskeleton/control/finger_kinematics.h"
#include "haptex/exoskeleton/control/force_command.h"
#include "haptex/exoskeleton/control/force_controller.h"
#include "haptex/exoskeleton/control/homing.h"
#include "haptex/exoskeleton/control/motor_encoders.h"
#include "haptex/exoskeleton/control/safety_chain.h"
#include "haptex/exoskeleton/control/smooth_command.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {

/// Why a finger feels no force, most important first; kNone if nothing stands in the way.
enum class NoForceReason {
  kNone,
  kNoDevice,  ///< no states from the device, or it does not get the commands
  kFault,     ///< latched, see DeviceController::fault()
  kHoming,
  kNotHomed,
  kDisabled,
  kPaused,
  kNoCommand,      ///< nobody commands a force: none yet, or the last one is too old
  kOutsideLimits,  ///< a joint is outside of its limits
  kSingular,
};
const char* describe(NoForceReason reason);

/// What is known of a finger, in hand_base. Before homing the angles, and what follows from them,
/// are those of a device that was switched on with its joints at their lower limits.
struct FingerMeasurement {
  JointVector joint_angles = JointVector::Zero();          ///< rad
  JointVector joint_velocities = JointVector::Zero();      ///< rad/s
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of <finger>_tip (m)
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, measured, on the person's fingertip
  Eigen::Vector3d desired_force = Eigen::Vector3d::Zero();  ///< N, what left the safety chain
  NoForceReason no_force = NoForceReason::kNoDevice;
  SafetyStatistics safety;
};

/// Measures, homes and renders. Not thread-safe; allocates in the constructor only.
class FingerController {
 public:
  /// rad. A joint may be this far outside of its limits (3 degrees: the give of the stops and of
  /// the homing) before forces end. They return when it is within again.
  static constexpr double kLimitTolerance = 0.052;
  /// After a singular configuration forces return where the smallest singular value is this many
  /// times kSingular, so that they do not flicker at its edge.
  static constexpr double kLeaveSingular = 1.1;

  /// @throws std::invalid_argument as FingerKinematics
  FingerController(const std::string& urdf, Finger finger);

  /// Takes what the device has measured. @param dt s since the reading before, ignored the first
  /// time @returns false if the encoders have jumped; the angles stay as they were then
  bool measure(const FingerReading& reading, double dt);
  /// The encoders' counts have a new zero: the next reading starts over from it.
  void restartEncoders() { encoders_.restart(); }

  /// Takes a commanded force if it is finite, counts it otherwise. @param obeyed forces are
  /// rendered; if not, the command is forgotten
  void command(const ForceCommand& command, bool obeyed, Time now);

  /// m/s^2, in hand_base: the weight of the links under it is held while forces are rendered. Zero:
  /// not known, nothing is held. @param gravity finite
  void setGravity(const Eigen::Vector3d& gravity) { gravity_ = gravity; }

  /// See SafetyChain::commanderDied().
  void commanderDied(Time now) { chain_.commanderDied(now); }

  void startHoming(Time now);
  /// @returns N m; the encoders are calibrated once homing().status() is kDone
  MotorVector home(Time now);
  const Homing& homing() const { return homing_; }

  /// Forces are rendered from now on, with a soft start.
  void startForces(Time now);
  /// One period with forces. @param hold why there is to be none, or kNone @returns N m
  MotorVector renderForces(NoForceReason hold, Time now);
  /// One period on the way to no forces. @returns N m
  MotorVector endForces(Time now);
  /// True once endForces() has ended them.
  bool forcesEnded() const { return control_.released(); }

  void latchFault() { chain_.latchFault(); }
  void clearFault() { chain_.clearFault(); }

  /// After the motors, once per period: why there is no force, if something stands in the way.
  void report(NoForceReason hold);
  /// No reading came in this period.
  void noReading() { measured_now_ = false; }

  const FingerMeasurement& measurement() const { return measurement_; }
  const FingerKinematics& kinematics() const { return kinematics_; }

 private:
  void updatePose();
  NoForceReason mechanicalReason() const;
  ForceInput forceInput(bool obeyed);

  FingerKinematics kinematics_;
  MotorVector lower_stops_;  // rad, angles of the motors
  JointVector coupling_offset_;
  MotorEncoders encoders_;
  Homing homing_;
  SafetyChain chain_;
  ForceController control_;
  FingerMeasurement measurement_;
  SmoothCommand command_;
  Eigen::Matrix3d jacobian_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  bool has_command_ = false;
  bool measured_now_ = false;
  bool sensor_works_ = false;
  bool outside_limits_ = false;
  bool singular_ = false;
};

}  // namespace haptex::exoskeleton
