// A piece of the large-scale mesh, refined: topology, matrices and state of the small-scale layer.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/mesh.h"

namespace haptex::contact {

class Patch {
 public:
  std::size_t particleCount() const { return positions_.size(); }
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }  ///< m, world frame
  const std::vector<std::array<int, 3>>& triangles() const { return mesh_.triangles; }
  /// Magnitude of the contact force on every particle (N).
  const std::vector<double>& contactForces() const { return contact_forces_; }

 private:
  cloth::ClothMesh mesh_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<double> contact_forces_;
};

}  // namespace haptex::contact
