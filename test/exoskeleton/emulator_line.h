// The emulator as a driver sees it, through its pseudo-terminal. Time is handed in; only the bytes
// take real time to get from one end of the line to the other.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "haptex/exoskeleton/emulator/emulator.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/serial/serial_port.h"

namespace haptex::exoskeleton {

constexpr Time kStart = std::chrono::hours(1);

inline std::string urdf() {
  std::ifstream file(HAPTEX_SOURCE_DIRECTORY "/urdf/hand_exoskeleton.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A name for a symbolic link that no other test has.
inline std::string linkName() {
  static int links = 0;
  return (std::filesystem::temp_directory_path() /
          ("haptex_test_emulator_" + std::to_string(getpid()) + "_" + std::to_string(links++)))
      .string();
}

class EmulatorLine : public ::testing::Test {
 protected:
  EmulatorLine()
      : link_name(linkName()), emulator(urdf(), link_name, [this](const EmulatorSample& sample) {
          samples.push_back(sample);
        }) {}

  /// Time passes for both ends, and what arrives is collected.
  void run(Time duration) {
    for (const Time end = now + duration; now < end; now += Emulator::kPeriod) {
      emulator.advanceTo(now);
      driveOnce();
    }
  }

  /// Until the driver has states. @returns whether it got them within a second
  bool connect() {
    if (!port) port = std::make_unique<serial::SerialPort>(link_name);
    for (int i = 0; i < 1000 && driver.status() != LinkStatus::kConnected; ++i)
      run(std::chrono::milliseconds(1));
    return driver.status() == LinkStatus::kConnected;
  }

  void inject(const char* fault, const char* direction, double probability, double duration) {
    emulator.inject(parseFault(fault, direction, probability, duration));
  }

  Time now = kStart;
  std::string link_name;
  std::vector<EmulatorSample> samples;
  Emulator emulator;
  std::unique_ptr<serial::SerialPort> port;
  DeviceLink driver;
  bool commanding = false;  // by the driver, once a period
  DeviceCommand command;
  std::vector<DeviceState> states;
  std::vector<Time> arrivals;  // of states

 private:
  void driveOnce() {
    if (!port) return;
    // States come at once, but through a thread of the kernel.
    pollfd ready{port->descriptor(), POLLIN, 0};
    poll(&ready, 1, 1);
    std::array<std::uint8_t, 4096> bytes;
    driver.receive(bytes.data(), port->read(bytes.data(), bytes.size()), now);
    if (const DeviceState* state = driver.takeState()) {
      states.push_back(*state);
      arrivals.push_back(now);
    }
    port->write(driver.poll(now));
    if (commanding) port->write(driver.send(command));
    std::this_thread::sleep_for(std::chrono::microseconds(50));  // likewise the other way
  }
};

}  // namespace haptex::exoskeleton
