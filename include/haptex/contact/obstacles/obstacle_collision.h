// Collision of a cloth with the rigid obstacles of its scene, which may move.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/bodies/free_body.h"
#include "haptex/contact/bodies/placed_obstacle.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::contact {

/// Steps a cloth among obstacles. Before a step it finds what particles could touch within it, and
/// gives the cloth contacts that its implicit step keeps (cloth::ActiveSetContactSolver); after the
/// step what has gone through a surface nevertheless is brought back to the side that it came from,
/// without the velocity into the obstacle. Explicit steps know no contacts: they are only brought
/// back, without friction.
///
/// Particles are held kOffset above the surface, which is about half of a fabric's thickness, and
/// are never nearer than kOffset - kTolerance after a step, unless they are attached, or held by
/// two obstacles closer than that. Their friction is that of the fabric, on the border of several
/// the mean by area. Between two steps paths are taken as straight in the obstacle's
/// frame and followed all along, so that neither speed nor thin obstacles let a particle through.
/// What happens between the particles is not looked at: what is smaller than the mesh's cells gets
/// through them, and a cell dips into a sphere of radius R by up to its size squared over 8 R.
///
/// All that does not concern a cloth that collides with itself: it gets the obstacles themselves
/// (cloth::Cloth::setObstacles()), and no part of it passes through them.
///
/// Obstacles with mass go as gravity, the cloth and what they touch push them: with backward Euler
/// in one implicit step with the cloth (cloth::BodyCoupling), with explicit steps by the impulses
/// of what has been brought back. Momentum of cloth and bodies together changes by nothing else but
/// gravity, attachments, air and other obstacles. One that is near nothing flies its parabola.
///
/// A step allocates nothing, but where such cloth is near to more than ever before.
class ObstacleCollision {
 public:
  static constexpr double kOffset = 5e-4;         ///< m
  static constexpr double kTolerance = 1e-6;      ///< m
  static constexpr std::size_t kMostBodies = 16;  ///< with mass

  /// @param cloth the one that is stepped, with contacts among its effects; its integrators are to
  ///   be made after, if an obstacle has mass
  /// @param start s, simulated, of the first step
  /// @throws std::invalid_argument what makeObstacle() says, if an obstacle has no friction of
  ///   its own and a fabric has none, or if the cloth collides with itself and a triangle of it
  ///   touches an obstacle or is inside of it at the start, what FreeBody says, if more than
  ///   kMostBodies have mass, or any if the cloth collides with itself
  ObstacleCollision(cloth::Cloth& cloth, std::vector<mesh::Obstacle> obstacles, double start = 0.0);

  /// Takes a step as cloth::Integrator::step(), from the obstacles' poses at the state's time to
  /// those at its end, and keeps the particles out of them.
  /// @throws what Integrator::step() throws, and what requireFriction() does for a fabric that was
  ///   set since
  cloth::StepReport step(cloth::Cloth& cloth, cloth::Integrator& integrator,
                         cloth::ClothState& state, double time_step);

  /// @throws std::invalid_argument if an obstacle has no friction of its own, and the fabric none
  void requireFriction(const material::Fabric& fabric) const;

  const std::vector<mesh::Obstacle>& obstacles() const { return obstacles_; }

  /// Those with mass, in the order of obstacles().
  const std::vector<FreeBody>& bodies() const { return bodies_; }
  /// Puts them where others are. @param bodies as many, what bodies() has been
  void setBodies(const std::vector<FreeBody>& bodies) { bodies_ = bodies; }

  /// Steps with an explicit method respond from now on by penalty and removal of velocity, as the
  /// mass-spring cloth of Deformable Objects (docs/mechanics.md, Penalty) did: a particle nearer
  /// than kOffset loses what of its velocity leads into an obstacle, and one inside is pushed out
  /// by `stiffness` (N/m) times its depth. Nothing is brought back.
  /// @throws std::invalid_argument unless it is finite and > 0
  void setPenalty(double stiffness);

 private:
  void addObstacle(const cloth::Cloth& cloth, const mesh::Obstacle& obstacle, double start);
  void shareFriction(const cloth::Cloth& cloth);
  double frictionAt(int particle, std::size_t obstacle) const;
  void addBodies(cloth::Cloth& cloth);
  void placeObstacles(const cloth::Cloth& cloth, double begin, double end);
  void predictBodies(const Eigen::Vector3d& gravity, double h);
  void findContacts(const cloth::Cloth& cloth, const cloth::ClothState& state, double h);
  void findContact(const cloth::ClothState& state, int particle, double h);
  void moveBodies(const Eigen::Vector3d& gravity, const std::vector<cloth::BodyMotion>& motions,
                  double h);
  bool isAlone(int body) const;
  void resolve(const cloth::Cloth& cloth, cloth::ClothState& state, double h);
  bool bringBack(double mass, const Eigen::Vector3d& from, double h, PlacedObstacle& obstacle,
                 Eigen::Vector3d& position, Eigen::Vector3d& velocity);
  void pushOut(const cloth::Cloth& cloth, cloth::ClothState& state, double h);
  void takeBack(cloth::ClothState& state);
  void stopAt(const PlacedObstacle& obstacle, double mass, const Eigen::Vector3d& place,
              const Eigen::Vector3d& normal, double h, Eigen::Vector3d& velocity);

  std::vector<mesh::Obstacle> obstacles_;
  std::vector<PlacedObstacle> placed_;
  // Of a cloth of several fabrics, per particle: how much of its area is of the first, and what the
  // others add to its coefficient. Empty: there is one.
  std::vector<double> first_share_, other_friction_;
  std::vector<FreeBody> bodies_;
  cloth::RigidBodies rigid_;                       // those of this step
  std::optional<cloth::BodyContactSolver> alone_;  // how they go without the cloth
  Eigen::VectorXd momenta_, velocities_;           // of all bodies
  std::vector<cloth::BodyMotion> motions_;
  std::optional<double> penalty_;           // N/m
  std::vector<Eigen::Vector3d> before_;     // m/s, with penalty_: at the beginning
  std::vector<FreeBody> bodies_before_;     // likewise
  std::vector<Eigen::Vector3d> positions_;  // m, at the beginning of the step
  std::vector<cloth::ParticleContact> contacts_;
};

}  // namespace haptex::contact
