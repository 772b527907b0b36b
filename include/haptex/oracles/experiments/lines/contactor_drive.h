// Driver and drive electronics of the contactors in simulated time: a source of amplitudes, the
// driver, the serial line with its faults, and the firmware.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/oracles/experiments/lines/simulated_line.h"
#include "haptex/tactile/drive/array_driver.h"
#include "haptex/tactile/drive/drive_firmware.h"

namespace haptex::oracles {

/// Reproducible. The source says new amplitudes every kTactileStep, the driver ticks every
/// kDrivePeriod, 1 ms later than the source.
class ContactorDrive {
 public:
  using Time = base::Time;
  using Amplitudes = base::PerFinger<tactile::ArrayAmplitudes>;

  static constexpr Time kStep = std::chrono::microseconds(250);

  explicit ContactorDrive(const tactile::Calibration& calibration, unsigned seed = 1);

  /// What the source says at a time, m. Nothing: it is silent.
  void setSource(std::function<Amplitudes(Time)> source) { source_ = std::move(source); }
  /// Its process has died, which its connection shows.
  void killSource();
  /// From now on the driver does nothing. @param noticed whether the line tells the electronics
  void killDriver(bool noticed);
  /// The cable is out, or in again.
  void unplug(bool out) { open_ = !out; }

  /// Takes steps for so long.
  /// @param observe called after every step; may be empty
  void run(Time duration, const std::function<void()>& observe = {});

  Time now() const { return now_; }
  const tactile::DriveFirmware& firmware() const { return firmware_; }
  const tactile::ArrayDriver& driver() const { return driver_; }
  serial::FaultInjector& toDevice() { return to_device_.faults(); }
  serial::FaultInjector& toDriver() { return to_driver_.faults(); }
  /// Commands that the electronics have obeyed and the driver had not sent.
  int wronglyObeyed() const { return wrongly_obeyed_; }
  /// Whether any contactor is driven.
  bool moves() const;

 private:
  void serve();
  void step();
  void compareObeyed(std::uint64_t before);

  const tactile::Calibration calibration_;
  SimulatedLine to_device_, to_driver_;
  bool open_ = true;
  Time now_{0};
  tactile::DriveFirmware firmware_;
  tactile::ArrayDriver driver_;
  bool driver_lives_ = true;
  bool hang_up_ = false;
  std::function<Amplitudes(Time)> source_;
  Time source_due_{0};
  Time tick_due_ = std::chrono::milliseconds(1);
  Time report_due_{0};
  std::array<tactile::DriveCommand, 64> sent_{};  // the newest
  std::size_t sends_ = 0;
  int wrongly_obeyed_ = 0;
};

/// A contactor's displacement (m) at sample n of a rate.
double displacement(const tactile::PerChannel<double>& amplitudes, long long sample,
                    double sample_rate);

}  // namespace haptex::oracles
