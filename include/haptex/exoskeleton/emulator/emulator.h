// The emulated exoskeleton in real time: firmware, mechanics and the person's fingers behind a
// serial line with faults on demand. Knows no ROS and reads no clock.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptex/exoskeleton/emulator/emulated_device.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/serial/emulated_line.h"
#include "haptex/serial/emulator_fault.h"

namespace haptex::exoskeleton {

using serial::EmulatedLine;
using serial::EmulatorFault;
using serial::LineStatistics;

/// Faults of the emulated exoskeleton beside those of its line: the force sensors of both fingers
/// read the end of their range, or are shaken by the contactors of the tactile arrays.
constexpr char kSaturatedSensor[] = "saturated_sensor";
constexpr char kShakenSensor[] = "shaken_sensor";

/// As EmulatorFault::parse().
EmulatorFault parseFault(const std::string& fault, const std::string& direction, double probability,
                         double duration);

/// What is true at the end of a period, which is lived through at once when it is due.
struct EmulatorSample {
  Time time{0};  ///< when it was due, of the clock of advanceTo()
  PerFinger<EmulatedTruth> fingers;
};

struct EmulatorStatus {
  Time lag{0};                       ///< behind the clock when advanceTo() was last called
  Time largest_lag{0};               ///< since the last call of status()
  Time skipped{0};                   ///< time given up since the construction, for lag
  std::uint64_t skips = 0;           ///< times that happened, no unit
  std::uint64_t watchdog_trips = 0;  ///< of the firmware, no unit
  DriveMode mode = DriveMode::kOff;
  bool powered = true;
  bool port_open = true;
  std::string port_trouble;  ///< why the port could not be opened, or empty
  LineStatistics line;
  std::vector<std::string> faults;  ///< on now, in plain words
};

/// advanceTo(), setTarget() and turnHand() are for one thread; the other functions may be called
/// from any, and that thread does not wait for them.
class Emulator {
 public:
  static constexpr Time kPeriod = std::chrono::milliseconds(1);
  /// More lag than this is given up. Less than it takes the firmware's watchdog to act, so that
  /// catching up never trips it.
  static constexpr Time kMaxLag = std::chrono::milliseconds(4);
  static_assert(kMaxLag < FirmwareModel::kRampStart);
  /// How long the device is off when its power is cycled.
  static constexpr Time kOffTime = std::chrono::milliseconds(200);

  /// Runs in advanceTo() after every period.
  using Observer = std::function<void(const EmulatorSample&)>;

  /// @param urdf text of the exoskeleton's URDF
  /// @param link symbolic link to the port, see PseudoTerminal
  /// @throws std::invalid_argument as FingerKinematics, std::runtime_error as PseudoTerminal
  Emulator(const std::string& urdf, const std::string& link, Observer observer);

  /// As EmulatedDevice::setTarget().
  void setTarget(Finger finger, const Eigen::Vector3d& target);
  /// As EmulatedDevice::turnHand().
  void turnHand(const Eigen::Matrix3d& rotation);

  /// Lives through the periods that are due by now. The first call starts the time.
  void advanceTo(Time now);

  /// From the next period on. Asking for a fault again replaces it.
  void inject(const EmulatorFault& fault);

  /// Switches the device off and, after kOffTime, on again: it wants a handshake, and its encoders
  /// and its clock count from zero. The fingers stay where they are.
  void cyclePower();

  EmulatorStatus status();

 private:
  struct ActiveFault {
    EmulatorFault fault;
    Time end{0};
  };

  void livePeriod(Time now);
  void takeRequests(Time now);
  void apply(const EmulatorFault& fault, Time now);
  void note(const EmulatorFault& fault, Time now);
  void saturateSensors(bool saturated);
  void stepMechanics(Time now);
  void report(Time now);
  DeviceState stateSinceSwitchedOn();
  void showStatus(Time now);

  Observer observer_;
  EmulatedLine line_;
  EmulatedDevice device_;
  std::optional<FirmwareModel> firmware_;  // none while the device is off
  DeviceState last_report_;                // since it was switched on
  std::uint64_t watchdog_trips_ = 0;
  Time switch_on_at_{0};
  // What device_ counted when it was switched on.
  PerFinger<std::array<std::int32_t, kMotors>> first_counts_;
  std::uint32_t first_time_ = 0;  // us
  bool sensor_saturated_ = false;
  Time sensor_saturated_until_{0};
  Time sensor_shaken_until_{0};
  bool started_ = false;
  Time due_{0};  // begin of the next period
  Time skipped_{0};
  std::uint64_t skips_ = 0;
  EmulatorSample sample_;
  std::vector<ActiveFault> active_faults_;  // or which were; no two the same

  std::mutex mutex_;  // guards the following
  std::vector<EmulatorFault> requested_faults_;
  bool power_cycle_requested_ = false;
  EmulatorStatus status_;
  std::vector<ActiveFault> shown_faults_;
  Time shown_at_{0};
};

}  // namespace haptex::exoskeleton
