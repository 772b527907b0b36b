// Cloth that folds, heaps, twists and pulls tight, and does not pass through itself.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacle_collision.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::oracles {

/// Sheets of their own as one mesh. Their rest coordinates lie beside each other.
mesh::ClothMesh asOneMesh(const std::vector<mesh::ClothMesh>& sheets);

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

  /// @param settings of backward Euler
  SelfCollidingCloth(const Set& set, const material::Fabric& fabric,
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

/// - folded: a sheet that lies on a floor is folded twice,
/// - heaped: a sheet falls on its edge and heaps up,
/// - gathered: a curtain on rings is drawn to a tenth of its width,
/// - towel: falls over a pole, so that its ends swing together,
/// - ribbons: two that cross are wound around each other and pulled tight,
/// - twisted: the ends of a strip are turned against each other by a whole turn,
/// and those of obstacleSets().
/// @param cells along 100 mm, > 0
std::vector<SelfCollidingCloth::Set> selfCollisionScenes(int cells);

/// Thickness (m) of the compression curve at a pressure (Pa).
double thicknessAt(const material::Compression& compression, double pressure);

/// Layers on a lowest one that is attached, after some steps of 12.5 ms.
struct LayerStack {
  double exact;   ///< m, sum of the thicknesses that the compression curve gives for their weights
  double height;  ///< m, mean height of the highest middle surface over the lowest
};
/// @param layers > 1
LayerStack restingStack(const material::Fabric& fabric, int layers, int steps);

}  // namespace haptex::oracles
