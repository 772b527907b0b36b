// The emulator as a driver sees it, through its pseudo-terminal. Time is handed in; only the bytes
// take real time to get from one end of the line to the other.
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "haptex/exoskeleton/emulator/emulator.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/exoskeleton/protocol/serial_port.h"

namespace haptex::exoskeleton {
namespace {

using std::chrono::milliseconds;

constexpr Time kStart = std::chrono::hours(1);

std::string urdf() {
  std::ifstream file(HAPTEX_SOURCE_DIRECTORY "/urdf/hand_exoskeleton.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A name for a symbolic link that no other test has.
std::string linkName() {
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
    if (!port) port = std::make_unique<SerialPort>(link_name);
    for (int i = 0; i < 1000 && driver.status() != LinkStatus::kConnected; ++i)
      run(milliseconds(1));
    return driver.status() == LinkStatus::kConnected;
  }

  void inject(const char* fault, const char* direction, double probability, double duration) {
    emulator.inject(EmulatorFault::parse(fault, direction, probability, duration));
  }

  Time now = kStart;
  std::string link_name;
  std::vector<EmulatorSample> samples;
  Emulator emulator;
  std::unique_ptr<SerialPort> port;
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

TEST_F(EmulatorLine, AnswersTheHandshake) {
  ASSERT_TRUE(connect());
  EXPECT_EQ(driver.identity().version, kProtocolVersion);
  EXPECT_EQ(driver.identity().counts_per_revolution, kCountsPerRevolution);
}

TEST_F(EmulatorLine, SaysNothingBeforeTheHandshake) {
  port = std::make_unique<SerialPort>(link_name);
  for (int i = 0; i < 20; ++i) emulator.advanceTo(now += milliseconds(1));
  std::array<std::uint8_t, 100> bytes;
  EXPECT_EQ(port->read(bytes.data(), bytes.size()), 0u);
  EXPECT_EQ(emulator.status().line.bytes_out, 0u);
}

TEST_F(EmulatorLine, ReportsAStateEveryMillisecond) {
  ASSERT_TRUE(connect());
  run(milliseconds(50));
  const auto before = driver.statistics();
  states.clear();
  arrivals.clear();
  run(milliseconds(500));
  const LinkStatistics after = driver.statistics();
  // One may be under way at either end.
  EXPECT_NEAR(after.received.good_frames - before.received.good_frames, 500.0, 1.0);
  EXPECT_EQ(after.lost_states, before.lost_states);
  EXPECT_EQ(after.received.corrupt_frames, 0u);
  ASSERT_FALSE(states.empty());
  const double device_time = states.back().time - states.front().time;  // us
  const double line_time = 1e6 * seconds(arrivals.back() - arrivals.front());
  EXPECT_NEAR(device_time, line_time, 1000.0);
}

TEST_F(EmulatorLine, ObeysCommands) {
  ASSERT_TRUE(connect());
  commanding = true;
  command.mode = DriveMode::kForce;
  run(milliseconds(300));
  EXPECT_EQ(states.back().mode, DriveMode::kForce);
  EXPECT_LT(samples.back().fingers[Finger::kIndex].motor_force.norm(), 1e-9);
  command.torques[Finger::kIndex].setConstant(1e-3);
  run(milliseconds(300));
  EXPECT_GT(samples.back().fingers[Finger::kIndex].motor_force.norm(), 0.05);
  EXPECT_LT(samples.back().fingers[Finger::kThumb].motor_force.norm(), 1e-9);
  EXPECT_EQ(emulator.status().watchdog_trips, 0u);
  EXPECT_EQ(emulator.status().mode, DriveMode::kForce);
}

TEST_F(EmulatorLine, TakesTheMotorsToZeroWhenCommandsStop) {
  ASSERT_TRUE(connect());
  commanding = true;
  command.mode = DriveMode::kForce;
  command.torques[Finger::kThumb].setConstant(1e-3);
  run(milliseconds(100));
  ASSERT_GT(samples.back().fingers[Finger::kThumb].motor_force.norm(), 0.05);
  commanding = false;
  run(milliseconds(20));
  EXPECT_EQ(samples.back().fingers[Finger::kThumb].motor_force.norm(), 0.0);
  EXPECT_EQ(emulator.status().watchdog_trips, 1u);
  commanding = true;
  run(milliseconds(20));
  commanding = false;
  run(milliseconds(20));
  EXPECT_EQ(emulator.status().watchdog_trips, 2u);
}

TEST_F(EmulatorLine, MovesTheFingersToTheirTargets) {
  emulator.advanceTo(now);
  Eigen::Vector3d target(0.094, 0.022, -0.051);
  emulator.setTarget(Finger::kIndex, target);
  run(milliseconds(2000));
  EXPECT_LT((samples.back().fingers[Finger::kIndex].position - target).norm(), 0.005);
}

TEST_F(EmulatorLine, LivesThroughEveryPeriodOnce) {
  emulator.advanceTo(now);
  samples.clear();
  emulator.advanceTo(now + milliseconds(1));
  emulator.advanceTo(now + milliseconds(1) + std::chrono::microseconds(300));
  emulator.advanceTo(now + milliseconds(4));
  ASSERT_EQ(samples.size(), 4u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].time, now + milliseconds(1 + static_cast<int>(i)));
  }
  EXPECT_EQ(emulator.status().skips, 0u);
}

TEST_F(EmulatorLine, GivesUpAndCountsWhatItCannotCatchUpWith) {
  emulator.advanceTo(now);
  samples.clear();
  const Time stall = milliseconds(1000);
  emulator.advanceTo(now + stall);
  const auto caught_up = static_cast<std::size_t>(Emulator::kLargestLag / Emulator::kPeriod) + 1;
  EXPECT_EQ(samples.size(), caught_up);
  EXPECT_EQ(samples.back().time, now + stall);
  const EmulatorStatus status = emulator.status();
  EXPECT_EQ(status.skips, 1u);
  EXPECT_EQ(status.skipped, stall - Emulator::kPeriod - Emulator::kLargestLag);
  EXPECT_EQ(status.largest_lag, stall - Emulator::kPeriod);
  EXPECT_EQ(emulator.status().largest_lag, Time{0}) << "since the last look";
}

/// What a fault of the frames to the driver does to the statistics of its link.
struct FaultEffect {
  const char* fault;
  bool (*seen)(const LinkStatistics& before, const LinkStatistics& after);
};

class EmulatorFaults : public EmulatorLine, public ::testing::WithParamInterface<FaultEffect> {};

TEST_P(EmulatorFaults, ChangeTheStreamForTheirTimeOnly) {
  ASSERT_TRUE(connect());
  run(milliseconds(50));
  LinkStatistics before = driver.statistics();
  inject(GetParam().fault, "from_device", 0.5, 0.3);
  if (std::string(GetParam().fault) == "stall") inject("stall", "from_device", 1.0, 0.3);
  run(milliseconds(20));
  ASSERT_EQ(emulator.status().faults.size(), 1u);
  EXPECT_EQ(emulator.status().faults.front().find(GetParam().fault), 0u);
  run(milliseconds(280));
  EXPECT_TRUE(GetParam().seen(before, driver.statistics()));

  run(milliseconds(300));  // to recover, and to greet again
  EXPECT_TRUE(emulator.status().faults.empty());
  before = driver.statistics();
  EXPECT_EQ(driver.status(), LinkStatus::kConnected);
  run(milliseconds(200));
  const LinkStatistics after = driver.statistics();
  EXPECT_NEAR(after.received.good_frames - before.received.good_frames, 200.0, 1.0);
  EXPECT_EQ(after.lost_states, before.lost_states);
  EXPECT_EQ(after.repeated_states, before.repeated_states);
  EXPECT_EQ(after.received.corrupt_frames, before.received.corrupt_frames);
  EXPECT_EQ(after.received.garbage_bytes, before.received.garbage_bytes);
}

using Statistics = const LinkStatistics&;
INSTANTIATE_TEST_SUITE_P(
    ByName, EmulatorFaults,
    ::testing::Values(
        FaultEffect{"drop",
                    [](Statistics b, Statistics a) { return a.lost_states > b.lost_states; }},
        FaultEffect{"drop_bytes",
                    [](Statistics b, Statistics a) {
                      return a.received.garbage_bytes > b.received.garbage_bytes;
                    }},
        FaultEffect{
            "duplicate",
            [](Statistics b, Statistics a) { return a.repeated_states > b.repeated_states; }},
        FaultEffect{"flip",
                    [](Statistics b, Statistics a) {
                      return a.received.corrupt_frames > b.received.corrupt_frames;
                    }},
        FaultEffect{"truncate",
                    [](Statistics b, Statistics a) {
                      return a.received.garbage_bytes > b.received.garbage_bytes;
                    }},
        // Up to 20 ms: nothing is lost, and that is no timeout.
        FaultEffect{"delay",
                    [](Statistics b, Statistics a) {
                      return a.timeouts == b.timeouts && a.lost_states == b.lost_states;
                    }},
        FaultEffect{"reorder", [](Statistics b,
                                  Statistics a) { return a.repeated_states > b.repeated_states; }},
        FaultEffect{"garbage",
                    [](Statistics b, Statistics a) {
                      return a.received.garbage_bytes > b.received.garbage_bytes;
                    }},
        FaultEffect{"oversize",
                    [](Statistics b, Statistics a) {
                      return a.received.impossible_lengths > b.received.impossible_lengths;
                    }},
        FaultEffect{"wrong_version",
                    [](Statistics b, Statistics a) {
                      return a.received.corrupt_frames > b.received.corrupt_frames;
                    }},
        FaultEffect{"stall", [](Statistics b, Statistics a) { return a.timeouts > b.timeouts; }}),
    [](const auto& info) { return std::string(info.param.fault); });

TEST(EmulatorFaultNames, AreAllTried) {
  // Else a fault that is new in the room would not be tried above.
  EXPECT_EQ(lineFaults().size(), 11u);
}

TEST_F(EmulatorLine, FaultsOfTheOtherDirectionReachTheDevice) {
  ASSERT_TRUE(connect());
  commanding = true;
  command.mode = DriveMode::kForce;
  run(milliseconds(100));
  const LinkStatistics before = driver.statistics();
  inject("drop", "to_device", 1.0, 0.1);
  run(milliseconds(100));
  EXPECT_EQ(emulator.status().watchdog_trips, 1u);
  EXPECT_EQ(driver.statistics().lost_states, before.lost_states);
  EXPECT_EQ(driver.statistics().timeouts, before.timeouts);
}

TEST_F(EmulatorLine, AFaultEndsWhenItIsAskedForWithProbabilityZero) {
  ASSERT_TRUE(connect());
  inject("drop", "both", 1.0, 3600.0);
  inject("saturated_sensor", "both", 1.0, 3600.0);
  inject("closed_port", "both", 1.0, 3600.0);
  run(milliseconds(20));
  EXPECT_EQ(emulator.status().faults.size(), 4u);  // drop in each direction
  EXPECT_FALSE(emulator.status().port_open);
  for (const char* fault : {"drop", "saturated_sensor", "closed_port"}) {
    inject(fault, "both", 0.0, 1.0);
  }
  port.reset();
  driver.reset();
  run(milliseconds(5));
  EXPECT_TRUE(emulator.status().faults.empty());
  ASSERT_TRUE(connect());
  run(milliseconds(50));
  EXPECT_FALSE(states.back().fingers[Finger::kIndex].force_saturated);
}

TEST_F(EmulatorLine, AClosedPortIsGoneAndOpensAnewBehindTheSameLink) {
  ASSERT_TRUE(connect());
  const auto before = std::filesystem::read_symlink(link_name);
  inject("closed_port", "both", 1.0, 0.2);
  run(milliseconds(20));
  EXPECT_TRUE(port->closed());
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link_name)));
  EXPECT_THROW(SerialPort{link_name}, std::runtime_error);
  EXPECT_FALSE(emulator.status().port_open);
  run(milliseconds(170));
  EXPECT_FALSE(emulator.status().port_open);

  port.reset();
  driver.reset();
  run(milliseconds(20));
  EXPECT_TRUE(emulator.status().port_open);
  EXPECT_EQ(emulator.status().line.ports, 2u);
  EXPECT_TRUE(connect());
}

TEST_F(EmulatorLine, TriesAgainWhenThePortCannotBeOpened) {
  inject("closed_port", "both", 1.0, 0.05);
  run(milliseconds(20));
  std::ofstream(link_name) << "somebody else's";
  run(milliseconds(50));
  EXPECT_NE(emulator.status().port_trouble.find(link_name), std::string::npos);
  EXPECT_FALSE(emulator.status().port_open);
  std::filesystem::remove(link_name);
  run(EmulatedLine::kRetryPeriod);
  EXPECT_TRUE(emulator.status().port_open);
  EXPECT_EQ(emulator.status().port_trouble, "");
}

TEST_F(EmulatorLine, RefusesToReplaceAFileByItsLink) {
  const std::string name = linkName();
  std::ofstream(name) << "somebody else's";
  EXPECT_THROW(Emulator(urdf(), name, [](const EmulatorSample&) {}), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_regular_file(name));
  std::filesystem::remove(name);
}

TEST_F(EmulatorLine, RefusesAUrdfWithoutAnExoskeleton) {
  EXPECT_THROW(Emulator("<robot name='none'><link name='hand_base'/></robot>", linkName(),
                        [](const EmulatorSample&) {}),
               std::invalid_argument);
}

TEST_F(EmulatorLine, SaturatedSensorsReadTheEndOfTheirRange) {
  ASSERT_TRUE(connect());
  inject("saturated_sensor", "both", 1.0, 0.1);
  run(milliseconds(50));
  for (const Finger finger : kFingers) {
    EXPECT_TRUE(states.back().fingers[finger].force_saturated);
  }
  run(milliseconds(100));
  for (const Finger finger : kFingers) {
    EXPECT_FALSE(states.back().fingers[finger].force_saturated);
  }
}

TEST_F(EmulatorLine, PowerCycledTheDeviceForgetsAllButWhereItsFingersAre) {
  ASSERT_TRUE(connect());
  emulator.setTarget(Finger::kIndex, {0.05, 0.022, -0.07});
  run(milliseconds(1500));
  const auto moved = states.back().fingers[Finger::kIndex].encoder_counts;
  ASSERT_GT(std::abs(moved[1]), 100) << "the finger has moved";
  const auto angles = samples.back().fingers[Finger::kIndex].motor_angles;

  emulator.cyclePower();
  run(milliseconds(50));
  EXPECT_FALSE(emulator.status().powered);
  EXPECT_EQ(driver.status(), LinkStatus::kTimedOut);
  states.clear();
  ASSERT_TRUE(connect());
  run(milliseconds(50));
  EXPECT_TRUE(emulator.status().powered);
  ASSERT_FALSE(states.empty());
  EXPECT_LT(states.front().time, 300'000u);  // us
  for (const std::int32_t counts : states.back().fingers[Finger::kIndex].encoder_counts) {
    EXPECT_LT(std::abs(counts), 20);
  }
  EXPECT_LT((samples.back().fingers[Finger::kIndex].motor_angles - angles).norm(), 0.05);
}

TEST_F(EmulatorLine, MotorsAreOffWhileThePowerIs) {
  ASSERT_TRUE(connect());
  commanding = true;
  command.mode = DriveMode::kForce;
  command.torques[Finger::kIndex].setConstant(1e-3);
  run(milliseconds(100));
  ASSERT_GT(samples.back().fingers[Finger::kIndex].motor_force.norm(), 0.05);
  emulator.cyclePower();
  run(milliseconds(2));
  EXPECT_EQ(samples.back().fingers[Finger::kIndex].motor_force.norm(), 0.0);
}

}  // namespace
}  // namespace haptex::exoskeleton
