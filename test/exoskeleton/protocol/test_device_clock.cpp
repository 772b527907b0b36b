#include <gtest/gtest.h>

#include "haptex/exoskeleton/protocol/device_clock.h"

namespace haptex::exoskeleton::test_device_clock {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr Time kBegin = seconds(1000);  // of our clock

std::uint32_t us(Time time) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

/// A device that was switched on `ago` before kBegin, and states that are read `late` after they
/// were made, every millisecond.
struct Device {
  DeviceClock clock;
  Time ago = seconds(20);
  double speed = 1.0;

  bool reads(Time now, Time late = Time{0}) {
    const Time lived = now - late - kBegin + ago;
    return clock.receive(
        us(Time(static_cast<Time::rep>(speed * static_cast<double>(lived.count())))), now);
  }
  bool runs(Time from, Time to, Time late = Time{0}) {
    bool good = true;
    for (Time now = from; now < to; now += milliseconds(1)) good = reads(now, late) && good;
    return good;
  }
};

TEST(DeviceClock, BelievesADeviceWhoseStatesComeInTimeOrLate) {
  Device device;
  EXPECT_TRUE(device.runs(kBegin, kBegin + seconds(2)));
  EXPECT_TRUE(device.runs(kBegin + milliseconds(2016), kBegin + seconds(3), milliseconds(16)));
  EXPECT_TRUE(device.runs(kBegin + seconds(3), kBegin + seconds(4)));
}

TEST(DeviceClock, BelievesWhatWaitedWhileTheDriverStoodStill) {
  for (const Time still : {Time(milliseconds(700)), Time(seconds(10)), Time(minutes(10))}) {
    Device device;
    ASSERT_TRUE(device.runs(kBegin, kBegin + seconds(2)));
    // A buffer of the system holds the first 1.3 s; what came later found it full. The driver reads
    // 80 ms of them at a time, and then those of the present.
    Time now = kBegin + seconds(2) + still;
    for (Time made = kBegin + seconds(2); made < std::min(kBegin + milliseconds(3300), now);
         made += milliseconds(80)) {
      ASSERT_TRUE(device.reads(now, now - made)) << still.count();
      now += milliseconds(1);
    }
    EXPECT_TRUE(device.runs(now, now + seconds(2))) << still.count();
  }
}

TEST(DeviceClock, BelievesCrystalsThatDiffer) {
  for (const double speed : {0.9991, 1.0009}) {
    Device device;
    device.speed = speed;
    EXPECT_TRUE(device.runs(kBegin, kBegin + minutes(5))) << speed;
  }
}

TEST(DeviceClock, BelievesAClockThatWrapsAround) {
  Device device;
  device.ago = std::chrono::microseconds(0xFFFFFFFFu) - seconds(1);
  EXPECT_TRUE(device.runs(kBegin, kBegin + seconds(3)));
}

TEST(DeviceClock, BelievesADeviceThatWasSilentForLong) {
  for (const Time silent : {Time(seconds(30)), Time(minutes(40)), Time(minutes(100))}) {
    Device device;
    ASSERT_TRUE(device.runs(kBegin, kBegin + seconds(1)));
    EXPECT_TRUE(device.runs(kBegin + silent, kBegin + silent + seconds(1))) << silent.count();
  }
}

TEST(DeviceClock, NoticesOneThatStartsOver) {
  for (const Time lived : {Time(seconds(1)), Time(minutes(20)), Time(minutes(50))}) {
    Device device;
    device.ago = lived;
    ASSERT_TRUE(device.runs(kBegin, kBegin + seconds(2)));
    const Time now = kBegin + seconds(2);
    device.ago = kBegin - now;
    EXPECT_FALSE(device.reads(now)) << lived.count();
    EXPECT_TRUE(device.runs(now + milliseconds(1), now + seconds(1))) << "it is the clock from now";
  }
}

TEST(DeviceClock, NoticesOneThatRunsAhead) {
  Device device;
  ASSERT_TRUE(device.runs(kBegin, kBegin + seconds(2)));
  device.ago += milliseconds(502);
  EXPECT_FALSE(device.reads(kBegin + seconds(2)));
}

TEST(DeviceClock, NoticesOneThatStartsOverAfterTheDriverStoodStill) {
  Device device;
  ASSERT_TRUE(device.runs(kBegin, kBegin + seconds(2)));
  const Time now = kBegin + seconds(12);
  ASSERT_TRUE(device.reads(now, seconds(10)));
  device.ago = kBegin - now + seconds(3);  // switched on 3 s ago
  EXPECT_FALSE(device.reads(now + milliseconds(1)));
}

}  // namespace
}  // namespace haptex::exoskeleton::test_device_clock
