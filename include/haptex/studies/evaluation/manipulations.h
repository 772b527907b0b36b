// What a hand does with fabric to judge it, by the loops that ship, in simulated time, and what a
// device with two fingertips measures meanwhile. docs/evaluation_by_machine.md
#pragma once

#include <vector>

#include "haptex/base/finger.h"
#include "haptex/material/fabric.h"
#include "haptex/studies/evaluation/device_record.h"
#include "haptex/studies/evaluation/manipulation_settings.h"

namespace haptex::studies {

/// A manipulation by its name, and what is done.
struct Manipulation {
  const char* name;
  /// @throws std::invalid_argument what oracles::HapticLoop throws for the fabric or the settings
  DeviceRecord (*run)(const material::Fabric& fabric, const ManipulationSettings& settings);
};

/// With the hanging 200 mm sample, weft along y:
///   weigh: pinched near its lower edge, it is let go by the bar and hangs from the fingers.
///   drag: pinched in its middle, and the fingers slide down by 30 mm.
///   pinch: pinched in its middle three times, slowly, until the fingertips would be 1.6 mm deep in
///     each other, kPinchSeconds each.
/// With a strip of it that is held at both ends, vertically (kPressed; kBiased cut at 45 degrees):
///   press_warp, press_weft, press_bias: the index finger presses its middle along -x.
/// With a strip that is clamped horizontally and reaches over the index finger (kOverhang):
///   lower_warp, lower_weft: the finger goes down until the strip hangs by itself.
const std::vector<Manipulation>& manipulations();

/// What a hand knows of itself and of the samples that it cut.
constexpr double kPinchSeconds = 4.0;  ///< closing and opening
struct FingertipPair {
  base::PerFinger<double> radii = {};  ///< m, of the emulated device
  double pulp_stiffness = 0.0;         ///< Pa/m, of each, as the force renderer gives it
};
FingertipPair fingertipPair();

}  // namespace haptex::studies
