// The hierarchy over a cloth, fitted to its states when somebody looks.
#pragma once

#include <haptex/ClothState.h>

#include <Eigen/Core>
#include <cstdint>
#include <shared_mutex>
#include <vector>

#include "haptex/nodes/common/proximity_messages.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::nodes {

/// A state in the order in which they arrived.
struct ArrivedState {
  haptex::ClothStateConstPtr message;
  std::uint64_t number = 0;  ///< from 1, greater for later ones
};

/// Several threads may look at the same time; one that brings a new state waits for those that look
/// at the old one.
class FittedCloth {
 public:
  /// What does not change while it exists.
  struct View {
    std::shared_lock<std::shared_mutex> lock;
    const proximity::KdopHierarchy& hierarchy;  ///< fitted to the state
    const haptex::ClothState& state;
    double refit_seconds;  ///< computing time of the refit; NaN if none was needed
  };

  /// @throws std::invalid_argument what KdopHierarchy throws
  explicit FittedCloth(RestMesh mesh);

  const RestMesh& mesh() const { return mesh_; }

  /// @param state valid, with as many positions as the mesh has particles
  /// @returns that state, or one that arrived later
  View look(const ArrivedState& state);

 private:
  double refit(const ArrivedState& state);

  const RestMesh mesh_;
  std::shared_mutex mutex_;  // guards all below: shared to look, exclusive to refit
  proximity::KdopHierarchy hierarchy_;
  ArrivedState fitted_;
  std::vector<Eigen::Vector3d> positions_;  // m
};

}  // namespace haptex::nodes
