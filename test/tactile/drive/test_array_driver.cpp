// The driver with the electronics behind a simulated line: what it promises its user.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "haptex/oracles/experiments/lines/contactor_drive.h"

namespace haptex::tactile::test_array_driver {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using oracles::ContactorDrive;
using serial::LineFault;
using std::chrono::milliseconds;

ContactorDrive::Amplitudes twenty() {
  ContactorDrive::Amplitudes amplitudes;
  for (const Finger finger : kFingers) amplitudes[finger].fill({20e-6, 5e-6});
  return amplitudes;
}

class ArrayDriver : public ::testing::Test {
 protected:
  ArrayDriver() {
    drive_.setSource([](Time) { return twenty(); });
    drive_.run(milliseconds(250));
  }

  double displayed() {
    return amplitudesOf(drive_.firmware().drive(drive_.now())[Finger::kThumb],
                        calibration_[Finger::kThumb])[11][k40];
  }
  /// From now on, ms.
  double untilRest() {
    const Time begin = drive_.now();
    Time moved = begin;
    drive_.run(milliseconds(200), [&] {
      if (drive_.moves()) moved = drive_.now();
    });
    return base::milliseconds(moved - begin);
  }

  Calibration calibration_ =
      loadCalibration(std::string(HAPTEX_CONFIG_DIRECTORY) + "/tactile/representative.yaml");
  ContactorDrive drive_{calibration_};
};

TEST_F(ArrayDriver, DisplaysWhatItsSourceSays) { EXPECT_NEAR(displayed(), 20e-6, 5e-9); }

TEST_F(ArrayDriver, ContactorsRestWithin25MillisecondsOfTheDeathOfTheirSource) {
  drive_.killSource();
  EXPECT_LT(untilRest(), 25.0);
}

TEST_F(ArrayDriver, ContactorsRestWithin25MillisecondsOfAMessageThatDoesNotCome) {
  drive_.setSource({});
  EXPECT_LT(untilRest(), 25.0 + 25.0);
}

TEST_F(ArrayDriver, ContactorsRestWithin25MillisecondsOfADriverThatStalls) {
  drive_.killDriver(false);
  EXPECT_LT(untilRest(), 25.0);
}

TEST_F(ArrayDriver, AMessageThatIsTenMillisecondsLateIsNotFelt) {
  drive_.setSource({});  // it has just said something, and the next is due in 25 ms
  double least = 1.0;
  drive_.run(milliseconds(35), [&] { least = std::min(least, displayed()); });
  EXPECT_NEAR(least, 20e-6, 5e-9);
  drive_.run(milliseconds(15));
  EXPECT_FALSE(drive_.moves()) << "the source was not silent";
}

TEST_F(ArrayDriver, AFingerWhoseContactorsAreSwitchedOffDoesNotSilenceTheOther) {
  Calibration calibration = calibration_;
  calibration[Finger::kIndex].fill({{1e-4, 1e-4}, 0.0});
  ContactorDrive drive(calibration);
  drive.setSource([](Time) { return twenty(); });
  drive.run(milliseconds(250));
  const auto shares = drive.firmware().drive(drive.now());
  EXPECT_EQ(shares[Finger::kIndex][0][k40], 0.0);
  EXPECT_GT(shares[Finger::kThumb][0][k40], 0.0);
}

TEST_F(ArrayDriver, ConnectsAgainAfterTheCableWasOut) {
  drive_.unplug(true);
  EXPECT_LT(untilRest(), 25.0);
  EXPECT_FALSE(drive_.driver().status().port_open);
  drive_.unplug(false);
  drive_.run(milliseconds(200));
  EXPECT_NEAR(displayed(), 20e-6, 5e-9);
  EXPECT_EQ(drive_.driver().status().ports_lost, 1u);
}

TEST_F(ArrayDriver, CountsASilentDeviceAndComesBack) {
  drive_.toDriver().set(LineFault::kStall, 1.0, drive_.now() + milliseconds(100));
  drive_.run(milliseconds(90));
  EXPECT_EQ(drive_.driver().status().link, serial::LinkStatus::kTimedOut);
  EXPECT_FALSE(drive_.moves()) << "nobody knows whether it obeys";
  drive_.run(milliseconds(300));
  EXPECT_EQ(drive_.driver().status().link, serial::LinkStatus::kConnected);
  EXPECT_EQ(drive_.driver().status().link_statistics.timeouts, 1u);
  EXPECT_NEAR(displayed(), 20e-6, 5e-9);
}

TEST_F(ArrayDriver, SurvivesEveryFaultOfTheLineInBothDirections) {
  for (const LineFault fault : serial::lineFaults()) {
    const double probability = fault == LineFault::kStall ? 1.0 : 0.3;
    const Time end = drive_.now() + milliseconds(1000);
    drive_.toDevice().set(fault, probability, end);
    drive_.toDriver().set(fault, probability, end);
    drive_.run(milliseconds(1000), [&] { EXPECT_LE(displayed(), 20e-6) << name(fault); });
    drive_.run(milliseconds(400));
    EXPECT_NEAR(displayed(), 20e-6, 5e-9) << name(fault);
  }
  EXPECT_EQ(drive_.wronglyObeyed(), 0);
  EXPECT_GT(drive_.driver().status().watchdog_trips, 0u);
  EXPECT_GT(drive_.firmware().received().corrupt_frames, 0u);
}

}  // namespace
}  // namespace haptex::tactile::test_array_driver
