// Collision of a cloth with the rigid obstacles of its scene, which may move.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// Steps a cloth among obstacles. Before a step it finds what particles could touch within it, and
/// gives the cloth contacts that its implicit step keeps (cloth::ActiveSetContactSolver); after the
/// step what has gone through a surface nevertheless is brought back to the side that it came from,
/// without the velocity into the obstacle. Explicit steps know no contacts: they are only brought
/// back, without friction.
///
/// Particles are held kOffset above the surface, which is about half of a fabric's thickness, and
/// are never nearer than kOffset - kTolerance after a step, unless they are attached, or held by
/// two obstacles closer than that. Between two steps paths are taken as straight in the obstacle's
/// frame and followed all along, so that neither speed nor thin obstacles let a particle through.
/// What happens between the particles is not looked at: what is smaller than the mesh's cells gets
/// through them, and a cell dips into a sphere of radius R by up to its size squared over 8 R.
///
/// All that does not concern a cloth that collides with itself: it gets the obstacles themselves
/// (cloth::Cloth::setObstacles()), and no part of it passes through them.
///
/// A step allocates nothing, but where such cloth is near to more than ever before.
class ObstacleCollision {
 public:
  static constexpr double kOffset = 5e-4;     ///< m
  static constexpr double kTolerance = 1e-6;  ///< m

  /// @param cloth the one that is stepped, with contacts among its effects
  /// @param start s, simulated, of the first step
  /// @throws std::invalid_argument what makeObstacle() says, if an obstacle has no friction of
  ///   its own and the fabric has none, or if the cloth collides with itself and a triangle of it
  ///   touches an obstacle or is inside of it at the start
  ObstacleCollision(cloth::Cloth& cloth, std::vector<mesh::Obstacle> obstacles, double start = 0.0);

  /// Takes a step as cloth::Integrator::step(), from the obstacles' poses at the state's time to
  /// those at its end, and keeps the particles out of them.
  /// @throws what Integrator::step() throws, and the constructor if the fabric has lost its
  /// friction
  cloth::StepReport step(cloth::Cloth& cloth, cloth::Integrator& integrator,
                         cloth::ClothState& state, double time_step);

  /// @throws std::invalid_argument if an obstacle has no friction of its own and the fabric has
  /// none
  void requireFriction(const material::Fabric& fabric) const;

  const std::vector<mesh::Obstacle>& obstacles() const { return obstacles_; }

 private:
  /// An obstacle in its own frame, and where it is at both ends of the step.
  struct Body {
    proximity::RigidObstacle shape;
    double reach;  // m, radius around the origin that holds it and the offset
    Eigen::Isometry3d begin, end;
    double friction;
  };

  void placeBodies(const cloth::Cloth& cloth, double begin, double end);
  void findContacts(const cloth::Cloth& cloth, const cloth::ClothState& state, double h);
  void resolve(const cloth::Cloth& cloth, cloth::ClothState& state, double h) const;

  std::vector<mesh::Obstacle> obstacles_;
  std::vector<Body> bodies_;
  std::vector<Eigen::Vector3d> positions_;  // m, at the beginning of the step
  std::vector<cloth::ParticleContact> contacts_;
};

}  // namespace haptex::contact
