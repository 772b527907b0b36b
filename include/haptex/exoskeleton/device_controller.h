// Everything the driver does once per millisecond, without input, output or ROS: states of the
// device in, torques out.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "haptex/exoskeleton/clock.h"
#include "haptex/exoskeleton/device_messages.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/force_command.h"
#include "haptex/exoskeleton/operating_state.h"
#include "haptex/exoskeleton/safety_chain.h"

namespace haptex::exoskeleton {

/// Why a finger feels no force, most important first; kNone if nothing stands in the way.
enum class NoForceReason {
  kNone,
  kNoDevice,  ///< no states from the device
  kFault,     ///< latched, see DeviceController::fault()
  kDisabled,
  kPaused,
  kNotHomed,
  kHoming,
  kNoCommand,      ///< nobody commands a force: none yet, or the last one is too old
  kOutsideLimits,  ///< a joint is outside of its limits
  kSingular,
};
const char* describe(NoForceReason reason);

/// What is known of a finger, in hand_base.
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

/// Why a request was refused; empty if it was accepted.
using Refusal = std::string;

/// Not thread-safe. tick(), command() and the getters do not allocate.
class DeviceController {
 public:
  /// @param urdf text of the exoskeleton's URDF
  /// @throws std::invalid_argument as FingerKinematics
  explicit DeviceController(const std::string& urdf);

  /// Requests of a person. A refused one changes nothing.
  Refusal enable();
  Refusal disable();
  Refusal pause();
  Refusal home();
  Refusal clearFault();

  /// Takes a commanded force. One that is not finite is dropped and counted (SafetyStatistics).
  void command(Finger finger, const ForceCommand& command, Time now);

  /// Latches a fault from outside, for example of the port.
  void raiseFault(const std::string& why);

  /// One period. @param state the newest one of the device, or nullptr if none came
  const DeviceCommand& tick(const DeviceState* state, Time now);

  const FingerMeasurement& measured(Finger finger) const;
  const OperatingState& operatingState() const;
  /// What latched the fault, in plain words; empty without one.
  const std::string& fault() const;
};

}  // namespace haptex::exoskeleton
