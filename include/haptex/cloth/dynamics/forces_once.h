// Forces of a state for several readers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// The forces on all particles of a state, computed when they are first asked for and not again.
/// Cloth, state and buffer outlive it, and the first two do not change meanwhile.
class ForcesOnce {
 public:
  /// @param buffer of the forces; nothing is allocated once it has its size
  ForcesOnce(const Cloth& cloth, const ClothState& state, std::vector<Eigen::Vector3d>& buffer)
      : cloth_(cloth), state_(state), forces_(buffer) {}

  /// N: Cloth::computeForces()
  const std::vector<Eigen::Vector3d>& get() {
    if (!known_) cloth_.computeForces(state_, forces_);
    known_ = true;
    return forces_;
  }

 private:
  const Cloth& cloth_;
  const ClothState& state_;
  std::vector<Eigen::Vector3d>& forces_;
  bool known_ = false;
};

}  // namespace haptex::cloth
