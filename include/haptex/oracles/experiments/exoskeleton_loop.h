// The whole loop of the exoskeleton in simulated time: commander, driver, serial line, firmware and
// emulated device. Reproducible, and as fast as the processor allows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "haptex/exoskeleton/driver/driver_loop.h"
#include "haptex/exoskeleton/emulator/emulated_device.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/oracles/experiments/lines/simulated_line.h"

namespace haptex::oracles {

/// What the loop does at a moment, for one finger; forces in N, in hand_base.
struct LoopSample {
  base::Time time{0};
  Eigen::Vector3d commanded = Eigen::Vector3d::Zero();  ///< by the commander; zero once killed
  Eigen::Vector3d desired = Eigen::Vector3d::Zero();    ///< what left the safety chain
  Eigen::Vector3d motor_force = Eigen::Vector3d::Zero();
  Eigen::Vector3d contact_force = Eigen::Vector3d::Zero();
  exoskeleton::Mode mode = exoskeleton::Mode::kDisabled;
  exoskeleton::NoForceReason no_force = exoskeleton::NoForceReason::kNoDevice;
  exoskeleton::LinkStatus link = exoskeleton::LinkStatus::kConnecting;
};

/// The driver's loop (DriverLoop) ticks at 1 kHz, kDriverPhase after the device has sent a state.
/// The commander answers each state at once; what it leaves unanswered the driver waits for. The
/// device steps at EmulatedDevice::kRate.
class ExoskeletonLoop {
 public:
  static constexpr base::Time kStep = std::chrono::microseconds(125);
  static constexpr int kStepsPerTick = 8;
  /// In steps: a state of 50 bytes takes 0.54 ms at 921600 baud.
  static constexpr int kDriverPhase = 6;
  /// In steps: how long the driver waits for an answer, DriverLoop::kAnswerPatience.
  static constexpr int kPatience = 6;
  static_assert(kPatience * kStep >= exoskeleton::DriverLoop::kAnswerPatience &&
                (kPatience - 1) * kStep < exoskeleton::DriverLoop::kAnswerPatience);

  /// What a commander asks for. Called once per millisecond.
  using Commander = std::function<exoskeleton::ForceCommand(base::Finger, base::Time)>;
  /// Called after every step of the device.
  using Observer = std::function<void(const ExoskeletonLoop&)>;

  /// Commands no force at first.
  /// @param urdf text of the exoskeleton's URDF @param seed of noise and faults
  /// @param mechanics of device and person
  /// @throws std::invalid_argument as DeviceController
  ExoskeletonLoop(const std::string& urdf, unsigned seed,
                  const exoskeleton::FingerMechanics& mechanics = {});
  // The driver refers to its line.
  ExoskeletonLoop(const ExoskeletonLoop&) = delete;
  ExoskeletonLoop& operator=(const ExoskeletonLoop&) = delete;

  /// Connects, homes, enables, and waits until the soft start is over and the person is back.
  /// @throws std::runtime_error naming what failed
  void makeReady();

  void setCommander(Commander commander) { commander_ = std::move(commander); }
  /// The same force (N, in hand_base) on both fingertips from now on.
  void commandForce(const Eigen::Vector3d& force);

  /// The hand is held so (hand_base in world) from now on. The driver knows it if it is told, and
  /// is told what was so at a time; it is not told at first.
  void turnHand(const Eigen::Matrix3d& rotation) { device_.turnHand(rotation); }
  void tellOrientation(const Eigen::Matrix3d& rotation, base::Time at) {
    driver_.setGravity(exoskeleton::gravityIn(rotation), at);
  }

  void run(base::Time duration, const Observer& observer = {});

  /// The commander dies, and its connection to the driver with it: the driver knows in its next
  /// tick. The driver dies, and the line with it.
  void killCommander();
  void killDriver() { driver_lives_ = false; }
  /// The commander, or the driver, stands still from now on and then goes on. Connection and line
  /// stay open: the other end sees nothing but silence.
  void stallCommander(base::Time duration) { commander_stalls_until_ = now_ + duration; }
  void stallDriver(base::Time duration) { driver_stalls_until_ = now_ + duration; }
  /// What is measured does not reach the commander, who repeats the last commands.
  void stallMeasurements(base::Time duration) { measurements_stall_until_ = now_ + duration; }
  /// No torque from now on.
  void killMotors() { motors_live_ = false; }
  /// The line is unplugged, or plugged in again. The driver notices, latches a fault, and greets
  /// anew.
  void closePort();
  void openPort() { port_open_ = true; }

  base::Time now() const { return now_; }
  LoopSample sample(base::Finger finger) const;

  exoskeleton::EmulatedDevice& device() { return device_; }
  const exoskeleton::EmulatedDevice& device() const { return device_; }
  /// Of the driver.
  const exoskeleton::DeviceController& controller() const { return driver_.controller(); }
  exoskeleton::DeviceController& controller() { return driver_.controller(); }
  exoskeleton::DriverSnapshot driver() const { return driver_.status(); }
  exoskeleton::Refusal ask(exoskeleton::DriverRequest request) { return driver_.carryOut(request); }
  SimulatedLine& toDevice() { return to_device_; }
  SimulatedLine& toDriver() { return to_driver_; }

 private:
  void step();
  void stepDevice();
  void stepCommander();
  void beginDriver();
  void endDriver();

  exoskeleton::EmulatedDevice device_;
  exoskeleton::FirmwareModel firmware_;
  SimulatedLine to_device_, to_driver_;
  exoskeleton::DriverLoop driver_;
  Commander commander_;
  base::PerFinger<exoskeleton::ForceCommand> commands_;
  base::Time state_time_{-1};  // of the newest state that the driver has
  base::Time answered_{-1};    // of the state that the commands are computed from
  base::Time commander_stalls_until_{0}, driver_stalls_until_{0}, measurements_stall_until_{0};
  base::Time now_{0};
  std::uint64_t steps_ = 0;
  int waited_ = -1;  // steps, by the driver for answers; negative: its tick is done
  bool commander_lives_ = true, driver_lives_ = true, port_open_ = true;
  bool motors_live_ = true;
};

}  // namespace haptex::oracles
