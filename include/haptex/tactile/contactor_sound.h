// What one contactor of the tactile array drives, as a sound.
#pragma once

#include <string>
#include <vector>

#include "haptex/tactile/contactor_array.h"
#include "haptex/tactile/sound_file.h"

namespace haptex::tactile {

/// Amplitudes (m) of a contactor, one pair per step of tactile::kTactileStep.
using ContactorSteps = std::vector<tactile::PerChannel<double>>;

/// A finger that rubs to and fro, a second each way.
struct Rubbing {
  double speed = 0.05;   ///< m/s
  double angle = 0.0;    ///< rad, from weft towards warp
  double force = 0.5;    ///< N, spread evenly over the contactors
  double seconds = 4.0;  ///< s
};

/// The contactor nearest to the middle of the array, with an array as shipped. At both ends of the
/// way the finger takes a tenth of a second to come to rest and as long to be at its speed again.
/// @throws std::invalid_argument naming what of the rubbing is not allowed: speeds and forces > 0
///   up to 1 m/s and 20 N, finite angles, more than no time up to kLongestSound
ContactorSteps rubbedSteps(const tactile::Surface& surface, const Rubbing& rubbing);

/// Writes a WAV file of 16 bits, one channel, kSoundRate. It begins and ends with silence.
/// @throws std::invalid_argument naming the step and its amplitude unless it is finite and >= 0, or
///   the length if it is above kLongestSound; std::runtime_error naming the file if it cannot be
///   written
WrittenSound writeSound(const std::string& path, const ContactorSteps& steps);

}  // namespace haptex::tactile
