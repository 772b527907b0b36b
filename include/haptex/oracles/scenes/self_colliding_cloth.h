// A cloth that collides with itself and with obstacles, and whether it intersects.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::oracles {

/// Triangles of a cloth that touch a solid obstacle or are inside of it; or pairs of triangles, of
/// the cloth and of a mesh, that intersect, by the exact test. @param time s
std::size_t countIntersections(const std::vector<Eigen::Vector3d>& positions,
                               const std::vector<std::array<int, 3>>& triangles,
                               const mesh::Obstacle& obstacle, double time);

/// A cloth that collides with itself, stepped by backward Euler.
class SelfCollidingCloth {
 public:
  struct Set {
    mesh::ClothMesh mesh;
    double gravity = 9.81;                               ///< m/s^2
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, at the start
    std::vector<mesh::Obstacle> obstacles = {};
    /// Before every step: moves attachments to where they are at the end of it (s).
    std::function<void(cloth::Cloth& cloth, const cloth::ClothState& state, double end)> move = {};
    double duration = 1.0;  ///< s
    bool falls = false;     ///< and nothing else does work on it
    std::string name = {};
  };

  /// @param fabrics  that the mesh names
  /// @param settings of backward Euler
  SelfCollidingCloth(const Set& set, const std::vector<material::Fabric>& fabrics,
                     const cloth::StepSettings& settings);

  /// @throws std::runtime_error if the step is not accepted
  cloth::StepReport step(double h);
  /// J, potential and kinetic.
  double energy() const;
  /// Pairs of triangles of the cloth that intersect, and countIntersections() with all obstacles.
  std::size_t intersections() const;

  cloth::Cloth cloth;
  cloth::ClothState state;

 private:
  std::function<void(cloth::Cloth& cloth, const cloth::ClothState& state, double end)> move_;
  std::vector<mesh::Obstacle> obstacles_;
  cloth::Integrator integrator_;
  std::optional<contact::ObstacleCollision> collision_;
};

}  // namespace haptex::oracles
