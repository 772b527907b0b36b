// The emulated electronics through the bytes of a real pseudo-terminal, in simulated time.
#include <gtest/gtest.h>
#include <sndfile.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "../temporary_file.h"
#include "haptex/serial/serial_port.h"
#include "haptex/tactile/drive/array_driver.h"
#include "haptex/tactile/drive/emulated_electronics.h"

namespace haptex::tactile::test_emulated_electronics {
namespace {

using base::Finger;
using base::Time;
using std::chrono::milliseconds;

/// Opens the emulator's port whenever it is there.
class LinkedPort final : public serial::PortAccess {
 public:
  explicit LinkedPort(const std::string& path) : path_(path) {}

  bool takeNew() override {
    if (port_) return false;
    try {
      port_ = std::make_unique<serial::SerialPort>(path_);
    } catch (const std::runtime_error& error) {
      trouble_ = error.what();
      return false;
    }
    return true;
  }
  bool isThere() const override { return port_ != nullptr; }
  bool isClosed() const override { return port_ && port_->closed(); }
  void discard() override { port_.reset(); }
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    return port_->read(buffer, capacity);
  }
  bool write(serial::Bytes bytes) override { return port_->write(bytes); }
  bool awaitBytes(Time) override { return false; }
  std::string trouble() const override { return port_ ? "" : trouble_; }
  const std::string& path() const override { return path_; }

 private:
  std::string path_, trouble_;
  std::unique_ptr<serial::SerialPort> port_;
};

class Electronics : public ::testing::Test {
 protected:
  void run(Time duration, bool driver_lives = true) {
    for (const Time end = now_ + duration; now_ < end; now_ += milliseconds(1)) {
      if (driver_lives && now_ % kDrivePeriod == Time{0}) {
        ArrayAmplitudes amplitudes{};
        amplitudes.fill({20e-6, 10e-6});
        if (now_ % milliseconds(25) == Time{0}) driver_->receive(Finger::kThumb, amplitudes, now_);
        driver_->tick(now_);
      }
      electronics_->advanceTo(now_);
    }
  }
  void make(const std::optional<PlayedContactor>& played = {}) {
    electronics_ = std::make_unique<EmulatedElectronics>(link_.path(), calibration_, played);
    driver_ =
        std::make_unique<ArrayDriver>(std::make_unique<LinkedPort>(link_.path()), calibration_);
  }
  double displayed() { return electronics_->amplitudes(now_)[Finger::kThumb][5][k40]; }

  const TemporaryFile link_{".contactors"};
  Calibration calibration_ =
      loadCalibration(std::string(HAPTEX_CONFIG_DIRECTORY) + "/tactile/representative.yaml");
  std::unique_ptr<EmulatedElectronics> electronics_;
  std::unique_ptr<ArrayDriver> driver_;
  Time now_ = milliseconds(1000);
};

TEST_F(Electronics, DoWhatTheDriverSays) {
  make();
  run(milliseconds(300));
  EXPECT_NEAR(displayed(), 20e-6, 5e-9);
  EXPECT_EQ(electronics_->amplitudes(now_)[Finger::kIndex][5][k40], 0.0) << "nobody says anything";
  EXPECT_EQ(electronics_->sound(), nullptr);
}

TEST_F(Electronics, RestWhenTheDriverHasClosedItsPort) {
  make();
  run(milliseconds(300));
  driver_.reset();
  run(milliseconds(10), false);
  EXPECT_EQ(displayed(), 0.0);
  EXPECT_EQ(electronics_->watchdogTrips(), 1u);
}

TEST_F(Electronics, APortThatGoesIsFoundAgain) {
  make();
  run(milliseconds(300));
  electronics_->inject(serial::EmulatorFault::parse("closed_port", "both", 1.0, 0.1), now_);
  run(milliseconds(50));
  EXPECT_EQ(displayed(), 0.0);
  run(milliseconds(400));
  EXPECT_NEAR(displayed(), 20e-6, 5e-9);
  EXPECT_EQ(driver_->status().ports_lost, 1u);
}

TEST_F(Electronics, PlayAContactorAsASoundWithoutAJump) {
  const TemporaryFile sound(".contactor.wav");
  make(PlayedContactor{sound.path(), Finger::kThumb, 5});
  run(milliseconds(1500));
  electronics_.reset();
  SF_INFO info{};
  SNDFILE* const file = sf_open(sound.path().c_str(), SFM_READ, &info);
  ASSERT_NE(file, nullptr);
  std::vector<double> samples(static_cast<std::size_t>(info.frames));
  sf_read_double(file, samples.data(), info.frames);
  sf_close(file);
  EXPECT_EQ(info.samplerate, kSoundRate);
  EXPECT_GE(info.frames, kSoundRate) << "what was played until the last flush";
  double largest = 0.0, jump = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    largest = std::max(largest, std::abs(samples[i]));
    jump = std::max(jump, std::abs(samples[i] - samples[i - 1]));
  }
  // Nearly 30 um of 50; both sines are never at their tops at once.
  EXPECT_NEAR(kFullScale * largest, 30e-6, 1e-6);
  const double slope = 2.0 * M_PI * (40.0 * 20e-6 + 320.0 * 10e-6) / kSoundRate;  // m
  EXPECT_LT(kFullScale * jump, slope + kFullScale / 32767.0);
}

TEST_F(Electronics, ASoundThatCannotBeWrittenIsRefusedAtOnce) {
  EXPECT_THROW(make(PlayedContactor{"/no/such/folder/a.wav", Finger::kIndex, 0}),
               std::runtime_error);
}

}  // namespace
}  // namespace haptex::tactile::test_emulated_electronics
