// A hand that trembles, with a sample, by the loops that ship, in simulated time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "haptex/base/finger.h"
#include "haptex/contact/fingertip.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "haptex/oracles/experiments/haptic_loop.h"
#include "haptex/studies/evaluation/device_record.h"

namespace haptex::studies {

/// By which a hand strays from its way: each finger along each axis by three sines of 8 to 12 Hz,
/// together 14 um (root mean square). The frequencies are those of physiological tremor, the
/// amplitude is assumed.
class Tremor {
 public:
  /// @param seed of frequencies and phases, which are the same on every platform
  explicit Tremor(std::uint64_t seed);

  /// Adds to positions (m) and velocities (m/s) of fingertips that are there.
  void move(double time, contact::Fingertips& fingertips) const;

 private:
  struct Wave {
    double pulsation = 0.0, phase = 0.0;  // rad/s, rad
  };
  std::array<std::array<std::array<Wave, 3>, 3>, 2> waves_{};  // by finger, axis
};

/// A hand with a sample, and what its device measures from record() on.
class Trial {
 public:
  /// @param fingertips where they are at first
  /// @throws std::invalid_argument what oracles::HapticLoop throws
  Trial(oracles::HapticLoopSettings sample, std::uint64_t tremor,
        const contact::Fingertips& fingertips);

  /// Both fingertips to other places, evenly within `seconds`, in whole milliseconds.
  void moveTo(const contact::Fingertips& fingertips, double seconds);
  void rest(double seconds) { moveTo(fingertips_, seconds); }
  void record() { records_ = true; }
  /// The sample is let go by what holds it.
  void releaseAll() { loop_.releaseAll(); }
  const DeviceRecord& result() const { return record_; }

 private:
  void step(contact::Fingertips fingertips);

  oracles::HapticLoop loop_;
  Tremor tremor_;
  contact::Fingertips fingertips_;
  DeviceRecord record_;
  bool records_ = false;
};

}  // namespace haptex::studies
