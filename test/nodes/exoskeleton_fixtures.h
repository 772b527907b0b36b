// Devices at the other end of a real pseudo-terminal.
#pragma once

#include <stdlib.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "../exoskeleton/shipped_urdf.h"
#include "haptex/exoskeleton/device_end.h"
#include "haptex/exoskeleton/emulated_device.h"
#include "haptex/exoskeleton/pseudo_terminal.h"
#include "haptex/nodes/periodic_thread.h"

namespace haptex::nodes {

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "haptexXXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no directory " + name);
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The firmware's end of a pseudo-terminal: one period of its life.
class DeviceOnALine {
 public:
  explicit DeviceOnALine(const std::string& link) : terminal_(link), end_(identity()) {}

  const std::string& port() const { return terminal_.path(); }

  static exoskeleton::Identity identity() {
    exoskeleton::Identity identity;
    identity.serial_number = 42;
    return identity;
  }

  /// @returns what the motors are to do
  exoskeleton::DeviceCommand listen(exoskeleton::Time now) {
    std::array<std::uint8_t, 1024> bytes{};
    const std::size_t count = terminal_.read(bytes.data(), bytes.size());
    end_.receive(bytes.data(), count, now);
    const exoskeleton::Bytes answer = end_.answer();
    if (!answer.empty()) terminal_.write(answer);
    return end_.command(now);
  }

  void report(const exoskeleton::DeviceState& state, exoskeleton::Time now) {
    const exoskeleton::Bytes bytes = end_.report(state, now);
    if (!bytes.empty()) terminal_.write(bytes);
  }

 private:
  exoskeleton::PseudoTerminal terminal_;
  exoskeleton::DeviceEnd end_;
};

/// Says once per millisecond, on a thread of its own, that nothing moves.
class StillDevice {
 public:
  const std::string& port() const { return line_.port(); }

 private:
  void live(exoskeleton::Time now) {
    line_.listen(now);
    line_.report(exoskeleton::DeviceState(), now);
  }

  DeviceOnALine line_{""};
  PeriodicThread thread_{std::chrono::milliseconds(1),
                         [this](exoskeleton::Time now) { live(now); }};
};

/// The emulated exoskeleton in real time, on a thread of its own.
class LivingDevice {
 public:
  /// @param link symbolic link to its port
  explicit LivingDevice(const std::string& link) : line_(link) {}

 private:
  void live(exoskeleton::Time now) {
    const exoskeleton::DeviceCommand command = line_.listen(now);
    for (int i = 0; i < kSteps; ++i) device_.step(command);
    line_.report(device_.read(), now);
  }

  static constexpr int kSteps = static_cast<int>(exoskeleton::EmulatedDevice::kRate / 1000.0);

  DeviceOnALine line_;
  exoskeleton::EmulatedDevice device_{exoskeleton::shippedUrdf(), 1};
  PeriodicThread thread_{std::chrono::milliseconds(1),
                         [this](exoskeleton::Time now) { live(now); }};
};

}  // namespace haptex::nodes
