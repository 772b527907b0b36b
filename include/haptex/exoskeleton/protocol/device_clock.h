// Tells from the clock of a device whether it was switched off and on again.
#pragma once

#include <cstdint>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// A device that was switched off has a clock that starts over. A state may be read late, because
/// it waited in the line or in a buffer of the system while the driver stood still; then its time
/// is behind, by as much as it waited, but never before that of the state before, nor ahead of what
/// the states that waited least have shown. The clocks may differ in speed by 1/1000.
///
/// Not thread-safe, does not allocate.
class DeviceClock {
 public:
  /// The device's clock may be this much ahead before it counts as another one: so long the first
  /// state may have waited.
  static constexpr Time kTolerance = std::chrono::milliseconds(500);

  /// @param time us, of the device's clock, wraps around @param now when the state was read
  /// @returns whether it still is the clock of the states before; true for the first
  bool receive(std::uint32_t time, Time now);

 private:
  void anchor(std::uint32_t time, Time now);

  bool known_ = false;
  std::uint32_t anchor_ = 0;  // us, of the last state that has not waited
  Time anchored_{0};          // when that was read
  Time last_{0};              // when the last state was read
  Time lead_{0};              // of that before what the anchor lets expect
};

}  // namespace haptex::exoskeleton
