// What a device with two fingertips measures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/base/finger.h"

namespace haptex::studies {

/// In a millisecond.
struct DeviceSample {
  double time = 0.0;                                ///< s
  base::PerFinger<Eigen::Vector3d> positions = {};  ///< m, of the centres of the fingertips, world
  base::PerFinger<Eigen::Vector3d> forces = {};     ///< N, on the fingertips, world
};
using DeviceRecord = std::vector<DeviceSample>;

}  // namespace haptex::studies
