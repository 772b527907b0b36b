// Everything the driver does once per millisecond, without input, output or ROS: states of the
// device in, torques out.
#pragma once

#include <cstdint>
#include <string>

#include "haptex/exoskeleton/control/finger_controller.h"
#include "haptex/exoskeleton/control/force_command.h"
#include "haptex/exoskeleton/control/hand_gravity.h"
#include "haptex/exoskeleton/control/operating_state.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_clock.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {

/// Not thread-safe. tick(), observe(), drive(), command(), raiseFault() and the getters do not
/// allocate.
///
/// Commands that the device does not get are as dangerous as commands that nobody sends: its
/// firmware takes the motors to zero, and the first command it gets again would make the force
/// jump. So the desired force goes to zero while kRoundTrip has passed without a state that echoes
/// a newer command, and returns at the slew limit. Until then it goes on as if all were well.
class DeviceController {
 public:
  /// Without a state for this long there is no device; forces have gone to zero after kRoundTrip.
  static constexpr Time kStateTimeout = DeviceLink::kStateTimeout;
  /// Without a state for this long while the motors are on the device is lost, which is a fault. A
  /// serial adapter may hold back bytes for 16 ms, and a busy machine either process for longer.
  static constexpr Time kLostAfter = std::chrono::milliseconds(50);
  /// Just before the firmware starts to take the motors to zero, FirmwareModel::kRampStart.
  static constexpr Time kRoundTrip = std::chrono::microseconds(13500);

  /// @param urdf text of the exoskeleton's URDF
  /// @throws std::invalid_argument as FingerKinematics
  explicit DeviceController(const std::string& urdf);

  /// Requests of a person, see OperatingStateMachine. A refused one changes nothing.
  Refusal enable();
  Refusal disable();
  Refusal pause();
  /// Starts homing, in DISABLED only. It ends with is_homed, or with a fault that names the joint.
  Refusal home();
  /// Refused while the device is lost, if that was the cause.
  Refusal clearFault();

  /// Takes a commanded force. One that is not finite is dropped and counted (SafetyStatistics); one
  /// for a device that is not ENABLED is ignored.
  void command(Finger finger, const ForceCommand& command, Time now);

  /// Takes the direction of gravity, see HandGravity: the weight of the links is held where forces
  /// are rendered. @param gravity m/s^2, in hand_base @param at when it was so
  void setGravity(const Eigen::Vector3d& gravity, Time at) { gravity_.receive(gravity, at); }
  /// m/s^2, in hand_base, under which the weight is held; zero where it is not known.
  const Eigen::Vector3d& gravity() const { return gravity_.value(); }

  /// The one who commanded this finger is dead, which is known and not guessed from silence: its
  /// force goes to zero at once, until a command comes.
  void commanderDied(Finger finger, Time now) { fingers_[finger].commanderDied(now); }

  /// Latches a fault from outside, for example of the port. Cut after 250 characters.
  void raiseFault(const std::string& why);

  /// One period. @param state the newest one of the device, or nullptr if none came @param now
  /// never before that of the last tick
  const DeviceCommand& tick(const DeviceState* state, Time now) {
    observe(state, now);
    return drive(now);
  }
  /// The two halves of a period, between which commands for the state that was observed may come.
  void observe(const DeviceState* state, Time now);
  const DeviceCommand& drive(Time now);

  const FingerMeasurement& measured(Finger finger) const { return fingers_[finger].measurement(); }
  const OperatingState& operatingState() const { return states_.state(); }
  /// Whether the last command drove the motors: after disable() they are on until no torque is
  /// left.
  bool motorsOn() const { return command_.mode != DriveMode::kOff; }
  /// What latched the fault, in plain words; empty without one.
  const std::string& fault() const { return states_.fault(); }
  /// The latched fault is a silence of the device: it may work again without being homed.
  bool faultIsAStall() const { return device_lost_; }

 private:
  void latch(const char* why);
  void accept(const DeviceState& state, Time now);
  void followEcho(const DeviceState& state, Time now);
  void watchDevice(Time now);
  void home(Time now);
  void driveFingers(Time now);
  NoForceReason hold(Time now) const;

  OperatingStateMachine states_;
  PerFinger<FingerController> fingers_;
  HandGravity gravity_;
  DeviceCommand command_;
  DeviceClock clock_;
  Time now_{0};
  Time last_state_{0};             // when it came
  Time last_echo_{0};              // when a state last echoed a newer command
  std::uint32_t device_time_ = 0;  // us
  std::uint8_t echo_ = 0;
  bool echoes_ = false;  // the device has echoed something: one that never does is not watched
  bool device_tripped_ = false;
  bool state_seen_ = false;
  bool has_device_ = false;
  bool device_lost_ = false;  // this latched the fault
  bool forces_on_ = false;    // the motors are rendering, or on their way to no force
};

}  // namespace haptex::exoskeleton
