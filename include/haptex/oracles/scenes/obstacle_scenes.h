// Cloth among rigid obstacles, where exact results are known.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::oracles {

/// makeRectangle() with alternating diagonals, its middle moved to the origin, weft and warp along
/// x and y, then moved by a pose.
mesh::ClothMesh flatSheet(const Eigen::Vector2d& size, int cells_u, int cells_v,
                          const Eigen::Isometry3d& pose);

/// Not turned.
Eigen::Isometry3d placedAt(const Eigen::Vector3d& place);

/// A box of 2 m, 0.1 m thick, its top at a height (m).
mesh::Obstacle floorAt(double height);

/// A cloth that is stepped among obstacles.
struct CollidingCloth {
  cloth::Cloth cloth;
  cloth::ClothState state;
  contact::ObstacleCollision collision;
  cloth::Integrator integrator;

  /// @param gravity m/s^2, along -z
  CollidingCloth(mesh::ClothMesh mesh, const material::Fabric& fabric, double gravity,
                 const cloth::StepSettings& settings, std::vector<mesh::Obstacle> obstacles);
  /// @throws std::runtime_error if the step was not accepted
  cloth::StepReport step(double h);
  /// Sum of what the contacts exert on the cloth, N.
  Eigen::Vector3d contactForce() const;
  /// Signed distance (m) of the free particle that is nearest to an obstacle, now.
  double leastDistance() const;
  double energy() const { return cloth.potentialEnergy(state) + cloth.kineticEnergy(state); }
};

/// What becomes of a sheet of 100 mm that is laid on an incline at rest.
struct InclineOutcome {
  double way;           ///< m, down the incline in the first half second
  double acceleration;  ///< m/s^2, down the incline in the second quarter of a second
};
InclineOutcome slideDown(double angle, double friction, cloth::IntegrationMethod method, double h);

}  // namespace haptex::oracles
