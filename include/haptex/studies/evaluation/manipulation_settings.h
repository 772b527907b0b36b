// How the manipulations are computed, and the strips that are cut for them.
#pragma once

#include <cstdint>
#include <optional>

#include "haptex/cloth/dynamics/step.h"

namespace haptex::studies {

/// How the hand trembles and how finely the cloth is computed.
struct ManipulationSettings {
  std::uint64_t tremor = 0;  ///< seed of Tremor
  int cells = 32;            ///< of the 200 mm sample, along each side; strips have their own
  double large_scale_step = 0.0125;         ///< s, where there are two layers
  std::optional<cloth::StepSettings> step;  ///< of the large-scale cloth; none: of the oracles
};

struct Strip {
  double length = 0.0, width = 0.0;  ///< m
};
constexpr Strip kPressed{0.2, 0.012};   ///< between what holds it
constexpr Strip kBiased{0.2, 0.015};    ///< likewise
constexpr Strip kOverhang{0.03, 0.02};  ///< from the clamp on; the clamp's edge is at x = 0
}  // namespace haptex::studies
