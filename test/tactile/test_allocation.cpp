// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "../malloc_counter.h"
#include "fixtures.h"
#include "haptex/tactile/drive/array_driver.h"
#include "haptex/tactile/drive/drive_firmware.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile::test_allocation {
namespace {

TEST(TactileAllocation, AStepAllocatesNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  Surface surface;
  surface.small_scale = {kSpaceOfPeriodic(whiteNoise(60, 58)), 0.2};
  surface.large_scale = AmplitudeMap(2, 2, {{1.0, 0.5}, {0.9, 1.1}, {1.2, 1.3}, {0.8, 1.0}});
  TouchedFabric touched;
  touched.stroke = {{0.02, 0.01}, 0.5};
  touched.forces.fill(0.02);
  DriveWaveform even(48000.0), odd(44100.0), uneven(777.7);
  double largest = 0.0;

  const long before = allocations;
  for (int i = 0; i < 100; ++i) {
    touched.placement.origin.x() += 5e-4;
    const ArrayAmplitudes amplitudes = arrayAmplitudes(surface, touched, {});
    for (DriveWaveform* const waveform : {&even, &odd, &uneven}) {
      largest = std::max(largest, std::abs(waveform->step(amplitudes).back()[0]));
    }
    touched.stroke.velocity.y() = i % 10 == 0 ? std::nan("") : 0.01;
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(before, 0) << "the count does not work";
  EXPECT_GT(largest, 0.0);
}

TEST(TactileAllocation, NeitherDriverNorElectronicsAllocate) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  Calibration calibration;
  for (ArrayCalibration& array : calibration.values) array.fill({{1e-4, 1e-4}, 1e-4});
  DriveFirmware electronics(DriveIdentity{});
  // Both ends in one process: what one writes the other reads.
  class Loop final : public serial::PortAccess {
   public:
    explicit Loop(DriveFirmware& electronics) : electronics_(electronics) {}
    bool takeNew() override { return !std::exchange(there_, true); }
    bool isThere() const override { return there_; }
    bool isClosed() const override { return false; }
    void discard() override { there_ = false; }
    std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
      serial::Bytes bytes = electronics_.answer();
      if (bytes.empty()) bytes = electronics_.report(now);
      std::copy_n(bytes.data, std::min(capacity, bytes.size), buffer);
      return bytes.size;
    }
    bool write(serial::Bytes bytes) override {
      electronics_.receive(bytes.data, bytes.size, now);
      return true;
    }
    bool awaitBytes(base::Time) override { return false; }
    std::string trouble() const override { return ""; }
    const std::string& path() const override { return path_; }

    base::Time now{0};

   private:
    DriveFirmware& electronics_;
    bool there_ = false;
    std::string path_;
  };
  auto owned = std::make_unique<Loop>(electronics);
  Loop& loop = *owned;
  ArrayDriver driver(std::move(owned), calibration);
  ArrayAmplitudes amplitudes;
  amplitudes.fill({2e-5, 1e-5});
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    loop.now += kDrivePeriod;
    if (i % 5 == 0) driver.receive(base::Finger::kIndex, amplitudes, loop.now);
    driver.tick(loop.now);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(electronics.obeyed(), 900u);
  EXPECT_GT(electronics.drive(base::Finger::kIndex, 0, loop.now + kDrivePeriod)[k40], 0.19);
}

}  // namespace
}  // namespace haptex::tactile::test_allocation
