// What the emulator does as long as nothing is wrong, and when its power goes.
#include <cmath>
#include <fstream>
#include <set>

#include "emulator_line.h"

namespace haptex::exoskeleton::test_emulator {
namespace {

using std::chrono::milliseconds;

TEST_F(EmulatorLine, AnswersTheHandshake) {
  ASSERT_TRUE(connect());
  EXPECT_EQ(driver.identity().version, kProtocolVersion);
  EXPECT_EQ(driver.identity().counts_per_revolution, kCountsPerRevolution);
}

TEST_F(EmulatorLine, SaysNothingBeforeTheHandshake) {
  port = std::make_unique<serial::SerialPort>(link_name);
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
  const auto caught_up = static_cast<std::size_t>(Emulator::kMaxLag / Emulator::kPeriod) + 1;
  EXPECT_EQ(samples.size(), caught_up);
  EXPECT_EQ(samples.back().time, now + stall);
  const EmulatorStatus status = emulator.status();
  EXPECT_EQ(status.skips, 1u);
  EXPECT_EQ(status.skipped, stall - Emulator::kPeriod - Emulator::kMaxLag);
  EXPECT_EQ(status.largest_lag, stall - Emulator::kPeriod);
  EXPECT_EQ(emulator.status().largest_lag, Time{0}) << "since the last look";
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
}  // namespace haptex::exoskeleton::test_emulator
