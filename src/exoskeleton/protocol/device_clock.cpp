#include "haptex/exoskeleton/protocol/device_clock.h"

namespace haptex::exoskeleton {
namespace {

constexpr int kDrift = 1000;                                // one in so many
constexpr Time kResolution = std::chrono::milliseconds(1);  // of the device's steps

std::uint32_t microseconds(Time time) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

}  // namespace

void DeviceClock::anchor(std::uint32_t time, Time now) {
  known_ = true;
  anchor_ = time;
  anchored_ = last_ = now;
  lead_ = Time{0};
}

bool DeviceClock::receive(std::uint32_t time, Time now) {
  if (!known_) {
    anchor(time, now);
    return true;
  }
  const std::uint32_t expected = anchor_ + microseconds(now - anchored_);
  const Time lead = std::chrono::microseconds(static_cast<std::int32_t>(time - expected));
  const Time drift = (now - anchored_) / kDrift;
  const bool ahead = lead > kTolerance + drift;
  const bool back = lead - lead_ + (now - last_) < -kResolution;
  lead_ = lead;
  last_ = now;
  if (ahead || back || lead >= -drift) anchor(time, now);  // those that waited do not count
  return !ahead && !back;
}

}  // namespace haptex::exoskeleton
