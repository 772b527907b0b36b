// What the force loop is told of the whole cloth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace haptex::simulation {

/// A state of the large-scale layer.
struct LargeScaleState {
  std::vector<Eigen::Vector3d> positions;   ///< m, world frame
  std::vector<Eigen::Vector3d> velocities;  ///< m/s, world frame
  std::vector<char> attached;               ///< one per particle, nonzero where it is held
  std::uint32_t mesh = 0;                   ///< number of the mesh that it is of
  double simulated_time = 0.0;              ///< s
  /// s, of the steady clock, 0 to an hour, until the next step begins; 0: at once, or not known
  double until_next = 0.0;
};

}  // namespace haptex::simulation
