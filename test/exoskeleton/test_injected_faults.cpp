// What the faults that are injected into the emulator do to its line, its port and its sensors.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "emulator_line.h"

namespace haptex::exoskeleton::test_injected_faults {
namespace {

using std::chrono::milliseconds;

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

bool losesStates(Statistics before, Statistics after) {
  return after.lost_states > before.lost_states;
}

bool repeatsStates(Statistics before, Statistics after) {
  return after.repeated_states > before.repeated_states;
}

bool hasGarbage(Statistics before, Statistics after) {
  return after.received.garbage_bytes > before.received.garbage_bytes;
}

bool hasCorruptFrames(Statistics before, Statistics after) {
  return after.received.corrupt_frames > before.received.corrupt_frames;
}

bool hasImpossibleLengths(Statistics before, Statistics after) {
  return after.received.impossible_lengths > before.received.impossible_lengths;
}

/// Up to 20 ms late: nothing is lost, and that is no timeout.
bool losesNothing(Statistics before, Statistics after) {
  return after.timeouts == before.timeouts && after.lost_states == before.lost_states;
}

bool timesOut(Statistics before, Statistics after) { return after.timeouts > before.timeouts; }

INSTANTIATE_TEST_SUITE_P(
    ByName, EmulatorFaults,
    ::testing::Values(FaultEffect{"drop", losesStates}, FaultEffect{"drop_bytes", hasGarbage},
                      FaultEffect{"duplicate", repeatsStates},
                      FaultEffect{"flip", hasCorruptFrames}, FaultEffect{"truncate", hasGarbage},
                      FaultEffect{"delay", losesNothing}, FaultEffect{"reorder", repeatsStates},
                      FaultEffect{"garbage", hasGarbage},
                      FaultEffect{"oversize", hasImpossibleLengths},
                      FaultEffect{"wrong_version", hasCorruptFrames},
                      FaultEffect{"stall", timesOut}),
    [](const auto& info) { return std::string(info.param.fault); });

TEST(EmulatorFaultNames, AreAllTried) {
  // Else a fault that is new in the room would not be tried above.
  EXPECT_EQ(serial::lineFaults().size(), 11u);
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
  EXPECT_THROW(serial::SerialPort{link_name}, std::runtime_error);
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

TEST_F(EmulatorLine, ShakenSensorsReadTheVibrationOfTheContactorsWhileAskedTo) {
  ASSERT_TRUE(connect());
  const auto spread = [&] {
    states.clear();
    run(milliseconds(100));
    double sum = 0.0, squares = 0.0;
    for (const DeviceState& state : states) {
      const double force = state.fingers[Finger::kThumb].force.z();
      sum += force;
      squares += force * force;
    }
    const double mean = sum / static_cast<double>(states.size());
    return std::sqrt(squares / static_cast<double>(states.size()) - mean * mean);
  };
  // Of two sines: root of half the sum of the squares.
  const double shaken =
      std::hypot(EmulatedDevice::kSlowVibration, EmulatedDevice::kFastVibration) / std::sqrt(2.0);
  run(milliseconds(500));
  const double still = spread();
  inject("shaken_sensor", "both", 1.0, 0.2);
  EXPECT_NEAR(spread(), std::hypot(shaken, still), 0.1 * shaken);
  inject("shaken_sensor", "both", 0.0, 1.0);
  EXPECT_LT(spread(), 0.3 * shaken);
  EXPECT_TRUE(emulator.status().faults.empty());
}

}  // namespace
}  // namespace haptex::exoskeleton::test_injected_faults
