// How people move a hand from rest to rest.
#pragma once

namespace haptex::exoskeleton {

/// The share of the way done after the share t of the time, both from 0 to 1: the minimum of the
/// integral of the squared jerk. Flash and Hogan, The coordination of arm movements, J. Neurosci. 5
/// (1985).
constexpr double minimumJerk(double t) { return t * t * t * (10.0 + t * (6.0 * t - 15.0)); }

}  // namespace haptex::exoskeleton
