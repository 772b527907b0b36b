// How exactly the exoskeleton renders a force that stays: the simulated loop at rest.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptex/base/finger.h"

namespace haptex::oracles {

/// Mean of the contact force while a constant force was commanded in one pose (N, in hand_base).
struct StaticForce {
  base::Finger finger = base::Finger::kIndex;
  Eigen::Vector3d commanded = Eigen::Vector3d::Zero();
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();

  double error() const { return (measured - commanded).norm(); }
};

/// Both fingers in poses drawn at random by the seed, each force in a direction drawn at
/// random. The person yields to the force by centimetres; only poses are drawn in which the
/// mechanism can follow. The mean is that of 0.5 s, 2 s after the force was commanded.
/// @param urdf   text of the exoskeleton's URDF
/// @param forces N, at most 5
/// @throws std::runtime_error if the loop does not get ready or has a fault
std::vector<StaticForce> staticForces(const std::string& urdf, int poses,
                                      const std::vector<double>& forces, unsigned seed = 1);

}  // namespace haptex::oracles
