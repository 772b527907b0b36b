// Devices at the other end of a real pseudo-terminal.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "../exoskeleton/shipped_urdf.h"
#include "../temporary_directory.h"
#include "haptex/exoskeleton/emulator/emulated_device.h"
#include "haptex/exoskeleton/protocol/firmware_model.h"
#include "haptex/realtime/periodic_thread.h"
#include "haptex/serial/pseudo_terminal.h"

namespace haptex::exoskeleton {

using test::TemporaryDirectory;

/// The firmware's end of a pseudo-terminal: one period of its life.
class DeviceOnALine {
 public:
  explicit DeviceOnALine(const std::string& link) : terminal_(link), firmware_(identity()) {}

  const std::string& port() const { return terminal_.path(); }

  static Identity identity() {
    Identity identity;
    identity.serial_number = 42;
    return identity;
  }

  /// @returns what the motors are to do
  DeviceCommand listen(Time now) {
    std::array<std::uint8_t, 1024> bytes{};
    const std::size_t count = terminal_.read(bytes.data(), bytes.size());
    firmware_.receive(bytes.data(), count, now);
    const Bytes answer = firmware_.answer();
    if (!answer.empty()) terminal_.write(answer);
    return firmware_.command(now);
  }

  void report(const DeviceState& state, Time now) {
    const Bytes bytes = firmware_.report(state, now);
    if (!bytes.empty()) terminal_.write(bytes);
  }

 private:
  serial::PseudoTerminal terminal_;
  FirmwareModel firmware_;
};

/// Says once per millisecond, on a thread of its own, that nothing moves.
class StillDevice {
 public:
  const std::string& port() const { return line_.port(); }

 private:
  void live(Time now) {
    line_.listen(now);
    line_.report(DeviceState(), now);
  }

  DeviceOnALine line_{""};
  realtime::PeriodicThread thread_{std::chrono::milliseconds(1), [this](Time now) { live(now); }};
};

/// The emulated exoskeleton in real time, on a thread of its own.
class LivingDevice {
 public:
  /// @param link symbolic link to its port
  explicit LivingDevice(const std::string& link) : line_(link) {}

 private:
  void live(Time now) {
    const DeviceCommand command = line_.listen(now);
    for (int i = 0; i < kSteps; ++i) device_.step(command);
    line_.report(device_.read(), now);
  }

  static constexpr int kSteps = static_cast<int>(EmulatedDevice::kRate / 1000.0);

  DeviceOnALine line_;
  EmulatedDevice device_{exoskeleton::shippedUrdf(), 1};
  realtime::PeriodicThread thread_{std::chrono::milliseconds(1), [this](Time now) { live(now); }};
};

}  // namespace haptex::exoskeleton
