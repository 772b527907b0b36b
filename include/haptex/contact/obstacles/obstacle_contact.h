// Contact of the particles of a patch with the obstacles of its scene, at the rate of the patch.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "haptex/contact/sphere_contact.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::contact {

/// The obstacles of a scene where they are at one time, without those that have mass: where these
/// are, the large-scale layer alone knows.
class PlacedObstacles {
 public:
  struct Body {
    proximity::RigidObstacle shape;  ///< in its own frame
    std::vector<double> friction;    ///< of every fabric on it
    Eigen::Isometry3d pose;          ///< from its own frame to the world frame
    Eigen::Isometry3d to_own;        ///< the inverse
  };

  PlacedObstacles() = default;
  /// @throws std::invalid_argument what makeObstacle() and frictionOn() say
  PlacedObstacles(std::vector<mesh::Obstacle> obstacles,
                  const std::vector<material::Fabric>& fabrics);

  /// @param time s, simulated
  void moveTo(double time);
  const std::vector<Body>& bodies() const { return bodies_; }

 private:
  std::vector<mesh::Obstacle> obstacles_;
  std::vector<Body> bodies_;
};

/// An obstacle is rigid, so what yields is the half of the fabric on its side: at a depth d below
/// where the middle surface rests without pressure, it pushes with the pressure of the compression
/// curve at the strain d / (thickness / 2). With the fingertip on the other side that makes pulp
/// and the whole fabric springs in series:
///   depth of the fingertip in the fabric = pressure / pulp stiffness + thickness - compressed
///   thickness(pressure).
/// Without pressure the middle surface rests ObstacleCollision::kOffset from the obstacle, as that
/// of the large-scale cloth does, whatever the thickness is. Friction is as on a fingertip
/// (SphereContact), with anchors that go along with the obstacle.
///
/// A particle that has come near stays on its side: until it is kTracked away again, an obstacle of
/// which it sees another side from within is met at the plane where it was nearest last. So neither
/// a thin obstacle nor a surface lets a particle through that moves less than kTracked in a step.
///
/// Nothing allocates after the constructor.
class ObstacleContact {
 public:
  static constexpr double kTracked = 5e-3;  ///< m, from an obstacle

  /// @param fabrics  of the cloth, with compression
  /// @param of_particles into these; empty: all are of the first
  /// @param sticking Pa/m: shear traction by displacement while the fabric sticks
  ObstacleContact(const PlacedObstacles& obstacles, const std::vector<material::Fabric>& fabrics,
                  std::vector<std::uint8_t> of_particles, double sticking,
                  std::size_t most_particles);

  /// Particles that touch an obstacle, once for each, and the forces on them; normals point out of
  /// the obstacle.
  const std::vector<TouchedParticle>& evaluate(const Particles& particles);
  /// Where the particles are after the step: moves the anchors as far as they slip, and remembers
  /// on which side they are.
  void commit(const Particles& particles);
  /// Of the last evaluate().
  const std::vector<TouchedParticle>& touched() const { return touched_; }
  /// Forgets all contacts.
  void clear();
  /// Takes over what another contact with the same obstacles knows of a particle.
  void adopt(int particle, const ObstacleContact& other, int other_particle);

 private:
  /// Of a particle and an obstacle, in the obstacle's frame.
  struct Place {
    Eigen::Vector3d last = Eigen::Vector3d::Zero();  // m, where it was asked for last
    double clearance = 0.0;                          // m, that it can move from there untracked
    bool tracked = false;
    Eigen::Vector3d surface = Eigen::Vector3d::Zero();  // m, nearest to it if tracked
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();   // unit, out of the obstacle
    bool holds = false;
    Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  // m
  };
  /// How far a particle is from an obstacle.
  struct Nearest {
    double distance;  // m, negative behind the surface
    Eigen::Vector3d normal, surface;
    bool on_side;  // false: it is behind the plane that is remembered
  };
  /// Calls visit(obstacle, particle, where that is in the obstacle's frame, m, its place) for all.
  template <typename Visit>
  void visitAll(const Particles& particles, const Visit& visit);
  bool isNear(const PlacedObstacles::Body& body, const Eigen::Vector3d& own, Place& place,
              Nearest& nearest) const;
  /// @param result with its particle
  bool touch(const PlacedObstacles::Body& body, const Nearest& nearest, const Place& place,
             const Eigen::Vector3d& own, double area, TouchedParticle& result) const;
  std::size_t fabricOf(int particle) const {
    return of_particles_.empty() ? 0 : of_particles_[particle];
  }

  const PlacedObstacles& obstacles_;
  std::vector<material::Compression> compressions_;  // of the fabrics
  std::vector<std::uint8_t> of_particles_;           // into these
  double sticking_;                                  // Pa/m
  std::vector<Place> places_;                        // by obstacle, then by particle
  std::size_t particles_;
  std::vector<TouchedParticle> touched_;
};

}  // namespace haptex::contact
