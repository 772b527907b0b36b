// The parts of validateTactile(), by what they look at, and what they share.
#pragma once

#include <array>
#include <string>

#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/experiments/standard_stroke.h"

namespace haptex::oracles {

/// k-space against the spectra of heights along strokes.
void validateTactileDirectly(const Sink& sink);
/// The shipped fabrics' intensity against their SMD, and weaves that differ in nothing else.
void validateTactileFabrics(const std::string& config_directory, const Sink& sink);

constexpr double kTactileRounding = 1e-10;  ///< of sums over some thousands of waves

/// Quantities for the two channels: the worst of several comparisons.
class BothChannels {
 public:
  explicit BothChannels(const std::string& name, double tolerance = kTactileRounding)
      : worst_{{{name + "/a40", 0.0, 0.0, -1.0, tolerance},
                {name + "/a320", 0.0, 0.0, -1.0, tolerance}}} {}

  /// Amplitudes against exact ones, the error relative to `scale`.
  void compare(const tactile::PerChannel<double>& exact,
               const tactile::PerChannel<double>& measured, double scale) {
    for (int i = 0; i < tactile::kChannels; ++i) {
      base::keepWorse(worst_[i], base::relativeTo(scale, worst_[i].name, exact[i], measured[i],
                                                  worst_[i].tolerance));
    }
  }
  /// The same, the error relative to the exact amplitude of each channel.
  void compare(const tactile::PerChannel<double>& exact,
               const tactile::PerChannel<double>& measured) {
    for (int i = 0; i < tactile::kChannels; ++i) {
      base::keepWorse(worst_[i], base::relativeTo(exact[i], worst_[i].name, exact[i], measured[i],
                                                  worst_[i].tolerance));
    }
  }
  void handTo(const Sink& sink) const {
    for (const base::Quantity& quantity : worst_) sink(quantity);
  }

 private:
  std::array<base::Quantity, tactile::kChannels> worst_;
};

}  // namespace haptex::oracles
