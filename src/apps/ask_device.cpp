// The program ask_device: who answers at a serial port. It greets and listens, and never commands:
// motors and contactors stay as they are. Needs no ROS master; `rosrun haptex doctor` calls it.
#include <poll.h>

#include <Eigen/Core>
#include <array>
#include <iostream>
#include <string>

#include "haptex/base/command_line.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/realtime/steady_clock.h"
#include "haptex/serial/serial_port.h"
#include "haptex/tactile/drive/drive_protocol.h"

namespace {

using haptex::base::kFingers;
using haptex::base::Time;
using haptex::realtime::steadyNow;
using haptex::serial::LinkStatistics;
using haptex::serial::LinkStatus;
using haptex::serial::SerialPort;

constexpr const char* kUsage =
    "usage: ask_device PORT\n"
    "Asks who is at a serial port, /dev/ttyUSB0 for example, and prints it as YAML.\n"
    "Exit status 1 if the port cannot be opened; that nobody answers is an answer (device: "
    "none).\n";

constexpr Time kPatience = std::chrono::seconds(2);          // for an answer
constexpr Time kListening = std::chrono::milliseconds(500);  // to states
constexpr Time kLongestWait =
    std::chrono::milliseconds(10);  // from one look at the clock to the next

/// Greets and takes states until a time of the steady clock, or until `isEnough()`.
template <typename Link, typename IsEnough, typename Take>
void listen(SerialPort& port, Link& link, Time until, IsEnough isEnough, Take take) {
  std::array<std::uint8_t, 4096> buffer;
  const timespec longest_wait = haptex::realtime::toTimespec(kLongestWait);
  for (Time now = steadyNow(); now < until && !port.closed() && !isEnough(); now = steadyNow()) {
    const haptex::serial::Bytes hello = link.poll(now);
    if (!hello.empty()) port.write(hello);
    pollfd file{port.descriptor(), POLLIN, 0};
    ::ppoll(&file, 1, &longest_wait, nullptr);
    const std::size_t count = port.read(buffer.data(), buffer.size());
    link.receive(buffer.data(), count, steadyNow());
    if (const auto* state = link.takeState()) take(*state);
  }
}

/// @returns how the link is after an answer, or after kPatience without one
template <typename Link>
LinkStatus greet(SerialPort& port, Link& link) {
  listen(
      port, link, steadyNow() + kPatience,
      [&link] { return link.status() != LinkStatus::kConnecting; }, [](const auto&) {});
  return link.status();
}

void showIdentity(const char* device, int version, int expected, int firmware, long serial_number) {
  std::cout << "device: " << device << "\nversion: " << version
            << "\nexpected_version: " << expected << "\nfirmware: " << firmware
            << "\nserial_number: " << serial_number << '\n';
}

void showLine(const LinkStatistics& statistics) {
  std::cout << "good_frames: " << statistics.received.good_frames
            << "\ncorrupt_frames: " << statistics.received.corrupt_frames
            << "\ngarbage_bytes: " << statistics.received.garbage_bytes
            << "\nlost_states: " << statistics.lost_states << '\n';
}

/// The mean force on each sensor (N) while it listens, and what the device says of its motors.
void showExoskeleton(SerialPort& port, haptex::exoskeleton::DeviceLink& link) {
  namespace exoskeleton = haptex::exoskeleton;
  haptex::base::PerFinger<Eigen::Vector3d> sums{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};
  exoskeleton::DeviceState last;
  int states = 0;
  listen(
      port, link, steadyNow() + kListening, [] { return false; },
      [&](const exoskeleton::DeviceState& state) {
        for (const auto finger : kFingers) sums[finger] += state.fingers[finger].force;
        last = state;
        ++states;
      });
  std::cout << "counts_per_revolution: " << link.identity().counts_per_revolution
            << "\nexpected_counts_per_revolution: " << exoskeleton::kCountsPerRevolution
            << "\nstates: " << states << '\n';
  if (states == 0) return;
  std::cout << "motors_off: " << (last.mode == exoskeleton::DriveMode::kOff ? "true" : "false")
            << '\n';
  for (const auto finger : kFingers) {
    const Eigen::Vector3d mean = sums[finger] / states;
    std::cout << haptex::base::name(finger) << "_force: [" << mean.x() << ", " << mean.y() << ", "
              << mean.z() << "]\n"
              << haptex::base::name(finger)
              << "_saturated: " << (last.fingers[finger].force_saturated ? "true" : "false")
              << '\n';
  }
}

void askContactors(SerialPort& port) {
  haptex::tactile::DriveLink link;
  greet(port, link);
  const auto& identity = link.identity();
  showIdentity("contactors", identity.version, haptex::tactile::kDriveVersion, identity.firmware,
               identity.serial_number);
  std::cout << "contactors: " << int{identity.contactors} << '\n';
  showLine(link.statistics());
}

void ask(SerialPort& port) {
  haptex::exoskeleton::DeviceLink link;
  const LinkStatus status = greet(port, link);
  const auto& identity = link.identity();
  if (status == LinkStatus::kConnecting) {
    std::cout << "device: none\n";
  } else if (identity.version >= haptex::tactile::kDriveVersion) {
    askContactors(port);
    return;
  } else {
    showIdentity("exoskeleton", identity.version, haptex::exoskeleton::kProtocolVersion,
                 identity.firmware, identity.serial_number);
    if (status == LinkStatus::kConnected) showExoskeleton(port, link);
  }
  showLine(link.statistics());
}

}  // namespace

int main(int argc, char** argv) {
  return haptex::base::runPlainProgram("ask_device", kUsage, {argv + 1, argv + argc}, 1, 1,
                                       [](const auto& arguments) {
                                         SerialPort port(arguments[0]);
                                         ask(port);
                                       });
}
