// The driver of the contactors without ROS: from amplitudes every 25 ms to commands on the serial
// line every 5 ms.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/serial/port_access.h"
#include "haptex/tactile/contactor_array.h"
#include "haptex/tactile/drive/calibration.h"
#include "haptex/tactile/drive/drive_protocol.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile {

/// What the driver knows after a tick.
struct DriverStatus {
  serial::LinkStatus link = serial::LinkStatus::kConnecting;
  serial::LinkStatistics link_statistics;
  DriveIdentity identity;
  bool port_open = false;
  bool watchdog_tripped = false;  ///< by the last state
  // Counts since the construction, no units.
  std::uint64_t commands = 0;       ///< sent
  std::uint64_t frames_unsent = 0;  ///< which the line did not take in time
  std::uint64_t ports_lost = 0;     ///< times an open port was found closed
  std::uint64_t watchdog_trips = 0;
};

/// Amplitudes go to those of the newest message along a straight line of kTactileStep. A finger
/// whose source is known to be dead, or has been silent for kSilence, is driven to zero at once,
/// which the electronics do within kDrivePeriod: the contactors rest 25 ms after the death that a
/// connection shows, and 25 ms after the message that did not come was due.
///
/// By one thread. Allocates nothing, but for what the port does.
class ArrayDriver {
 public:
  using Time = base::Time;
  using Finger = base::Finger;

  /// After the last amplitudes: they may be 10 ms late.
  static constexpr Time kSilence = std::chrono::milliseconds(35);

  ArrayDriver(std::unique_ptr<serial::PortAccess> port, const Calibration& calibration)
      : port_(std::move(port)), calibration_(calibration) {}

  /// @param amplitudes m, finite, >= 0
  void receive(Finger finger, const ArrayAmplitudes& amplitudes, Time now);
  /// Until the next amplitudes the contactors of the finger rest.
  void sourceDied(Finger finger) { sources_[finger].arrival.reset(); }

  /// Once per kDrivePeriod: states in, a command out.
  void tick(Time now);

  /// Whether amplitudes come.
  bool isDriven(Finger finger, Time now) const;
  /// Before calibration, m.
  ArrayAmplitudes amplitudes(Finger finger, Time now) const;

  /// Of the last tick, whether it could be sent or not.
  const DriveCommand& command() const { return command_; }
  const DriverStatus& status() const { return status_; }
  std::string portTrouble() const { return port_->trouble(); }
  const std::string& port() const { return port_->path(); }

 private:
  struct Source {
    std::optional<Time> arrival;  // of the newest amplitudes; none if the contactors are to rest
    ArrayAmplitudes from{};       // at the arrival
    ArrayAmplitudes to{};
  };

  static ArrayAmplitudes onTheWay(const Source& source, Time now);
  void takePort();
  void receiveBytes(Time now);
  void send(serial::Bytes bytes);
  void dropClosedPort();

  std::unique_ptr<serial::PortAccess> port_;
  Calibration calibration_;
  base::PerFinger<Source> sources_;
  DriveLink link_;
  DriveCommand command_;
  DriverStatus status_;
  std::array<std::uint8_t, 4096> received_{};  // more than a line brings in 40 ms
};

}  // namespace haptex::tactile
