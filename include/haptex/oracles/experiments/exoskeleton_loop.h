// The whole loop of the exoskeleton in simulated time: commander, driver, serial line, firmware and
// emulated device. Reproducible, and as fast as the processor allows.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/emulator/emulated_device.h"
#include "haptex/exoskeleton/emulator/fault_injector.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"

namespace haptex::oracles {

/// One direction of a serial line: what a FaultInjector lets through arrives byte by byte, 10 bits
/// each.
class SimulatedLine {
 public:
  /// @param baud_rate bits per second
  SimulatedLine(unsigned seed, int baud_rate) : faults_(seed), baud_rate_(baud_rate) {}

  void send(exoskeleton::Bytes frame, base::Time now) { faults_.send(frame, now); }
  /// To be called in every step: what the injector lets through starts on its way.
  void advance(base::Time now);
  /// What has arrived since the last call.
  const std::vector<std::uint8_t>& arrived(base::Time now);
  /// Loses what is on its way.
  void clear() { on_its_way_.clear(); }

  exoskeleton::FaultInjector& faults() { return faults_; }

 private:
  exoskeleton::FaultInjector faults_;
  int baud_rate_;
  base::Time free_at_{0};
  std::deque<std::pair<base::Time, std::uint8_t>> on_its_way_;
  std::vector<std::uint8_t> arrived_;
};

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

/// Commander and driver tick at 1 kHz, the driver kDriverPhase after the device has sent a state,
/// the commander at once before it; the device steps at EmulatedDevice::kRate.
class ExoskeletonLoop {
 public:
  static constexpr base::Time kStep = std::chrono::microseconds(125);
  static constexpr int kStepsPerTick = 8;
  /// In steps: a state of 50 bytes takes 0.54 ms at 921600 baud.
  static constexpr int kDriverPhase = 6;

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

  /// Connects, homes, enables, and waits until the soft start is over and the person is back.
  /// @throws std::runtime_error naming what failed
  void makeReady();

  void setCommander(Commander commander) { commander_ = std::move(commander); }
  /// The same force (N, in hand_base) on both fingertips from now on.
  void commandForce(const Eigen::Vector3d& force);

  void run(base::Time duration, const Observer& observer = {});

  /// The commander dies, and its connection to the driver with it: the driver knows in its next
  /// tick. The driver dies, and the line with it.
  void killCommander() { commander_lives_ = false; }
  void killDriver() { driver_lives_ = false; }
  /// The commander, or the driver, stands still from now on and then goes on. Connection and line
  /// stay open: the other end sees nothing but silence.
  void stallCommander(base::Time duration) { commander_stalls_until_ = now_ + duration; }
  void stallDriver(base::Time duration) { driver_stalls_until_ = now_ + duration; }
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
  exoskeleton::DeviceController& controller() { return controller_; }
  const exoskeleton::DeviceController& controller() const { return controller_; }
  exoskeleton::DeviceLink& link() { return link_; }
  SimulatedLine& toDevice() { return to_device_; }
  SimulatedLine& toDriver() { return to_driver_; }

 private:
  void step();
  void stepDevice();
  void stepCommander();
  void takeCommands();
  void stepDriver();

  exoskeleton::EmulatedDevice device_;
  exoskeleton::FirmwareModel firmware_;
  SimulatedLine to_device_, to_driver_;
  exoskeleton::DeviceLink link_;
  exoskeleton::DeviceController controller_;
  Commander commander_;
  base::PerFinger<Eigen::Vector3d> commanded_;
  struct Arrival {
    exoskeleton::ForceCommand command;
    base::Time time{0};
    bool is_new = false;
  };
  base::PerFinger<Arrival> arrivals_;  // at the driver, the newest of each finger
  base::Time commander_stalls_until_{0}, driver_stalls_until_{0};
  base::Time now_{0};
  std::uint64_t steps_ = 0;
  bool commander_lives_ = true, driver_lives_ = true, port_open_ = true;
  bool motors_live_ = true;
  bool death_is_known_ = false;  // of the commander, by the driver
};

}  // namespace haptex::oracles
