// What the fingers of a pinch exert on the large-scale cloth, as that has felt it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/point_loads.h"
#include "haptex/contact/large_scale_motion.h"
#include "haptex/mesh/mesh.h"

namespace haptex::contact {

struct CarriedForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< N, on the cloth
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of the cloth there
};

/// A load of force f and stiffness K at the place p pulls the cloth, which its step takes to x,
/// with f - K (x - p). Where the hand starts or stops at once, the long step of the large-scale
/// layer makes much of K (x - p), because its cloth has to get to p within the step; that is no
/// force that anybody should feel. So of it only the slow part is taken, which tells where the
/// cloth hangs.
///
/// Nothing allocates after the constructor.
class CarriedLoad {
 public:
  /// @param triangles of the large-scale mesh
  explicit CarriedLoad(const std::vector<std::array<int, 3>>& triangles) : triangles_(triangles) {
    loads_.reserve(cloth::PointLoads::kMax);
  }

  /// These go to the large-scale cloth, for its next step.
  /// @param gain the share of them that is to act, 0 to 1
  void send(const std::vector<cloth::PointLoad>& loads, double gain);
  /// That step's state has come.
  /// @param motion to it
  void receive(const LargeScaleMotion& motion);

  /// As the cloth is on its way to the last state; the velocity is of the last one that loads were
  /// sent for.
  CarriedForce now(const LargeScaleMotion& motion) const {
    return {end_ + motion.remaining() / motion.period() * (begin_ - end_), velocity_};
  }

 private:
  std::vector<std::array<int, 3>> triangles_;
  std::vector<cloth::PointLoad> loads_;                 // sent since the last state
  Eigen::Vector3d begin_ = Eigen::Vector3d::Zero();     // N, when the last state came
  Eigen::Vector3d end_ = Eigen::Vector3d::Zero();       // N, when it is reached
  Eigen::Vector3d slow_ = Eigen::Vector3d::Zero();      // N, of the stiffness
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // m/s
};

}  // namespace haptex::contact
