// What a hand does with a 200 mm sample to judge it, by the loops that ship, in simulated time, and
// what a device with two fingertips measures meanwhile. docs/evaluation_by_machine.md
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/base/finger.h"
#include "haptex/material/fabric.h"

namespace haptex::studies {

/// In a millisecond.
struct DeviceSample {
  double time = 0.0;                                ///< s
  base::PerFinger<Eigen::Vector3d> positions = {};  ///< m, of the centres of the fingertips, world
  base::PerFinger<Eigen::Vector3d> forces = {};     ///< N, on the fingertips, world
};
using DeviceRecord = std::vector<DeviceSample>;

/// How the hand trembles and how finely the cloth is computed.
struct ManipulationSettings {
  std::uint64_t seed =
      0;  ///< of the tremor: each finger by 14 um (root mean square) along each axis, 8 to 12 Hz
  int cells = 32;      ///< of the sample, along each side
  double rate = 80.0;  ///< Hz, of the large-scale cloth
};

/// A manipulation by its name, and what is done.
struct Manipulation {
  const char* name;
  /// @throws std::invalid_argument what oracles::HapticLoop throws for the fabric or the settings
  DeviceRecord (*run)(const material::Fabric& fabric, const ManipulationSettings& settings);
};

/// weigh: pinched near its lower edge, the sample is let go by the bar and hangs from the fingers.
/// drag: it hangs from the bar, is pinched in its middle, and the fingers slide down by 30 mm.
/// pinch: pinched in its middle, slowly, until the fingertips would be 1.6 mm deep in each other.
/// draw_warp, draw_weft: pinched firmly above its lower edge and drawn down by 8 mm.
/// shear: the same, drawn sideways by 12 mm.
const std::vector<Manipulation>& manipulations();

/// Of the emulated device, and the pulp that the force renderer gives them.
struct FingertipPair {
  base::PerFinger<double> radii = {};  ///< m
  double pulp_stiffness = 0.0;         ///< Pa/m, of each
};
FingertipPair fingertipPair();

}  // namespace haptex::studies
