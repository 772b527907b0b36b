// The mechanical model of a piece of cloth: mesh, fabric, what is modelled, attachments and loads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/particle_contact.h"
#include "haptex/cloth/dynamics/rigid_bodies.h"
#include "haptex/cloth/forces/constant_forces.h"
#include "haptex/cloth/forces/force_sum.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/cloth/forces/point_loads.h"
#include "haptex/cloth/forces/self_contact/self_contact.h"
#include "haptex/cloth/forces/ties.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::cloth {

/// What changes from step to step. World frame, SI units.
struct ClothState {
  std::vector<Eigen::Vector3d> positions;   ///< m
  std::vector<Eigen::Vector3d> velocities;  ///< m/s
  double time = 0.0;                        ///< s
  std::vector<double> memory;               ///< of the forces (Force::memorySize())

  /// What forces depend on.
  ForceState ofForces(linear::ThreadPool* pool = nullptr) const {
    return {positions, velocities, time, memory.data(), nullptr, pool};
  }
};

/// The place of an attached particle: it rests at `start` until `start_time`, then follows a
/// straight minimum-jerk path (Flash and Hogan 1985), or one at constant speed, by `displacement`
/// over `duration`, and rests at its end.
struct AttachmentPath {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();         ///< m
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m
  double start_time = 0.0;                                 ///< s, simulated
  double duration = 0.0;                                   ///< s, 0: at once
  bool at_constant_speed = false;                          ///< and still so in its last moment

  Eigen::Vector3d position(double time) const;
  /// m/s; zero in the moment of a jump, where `duration` is 0.
  Eigen::Vector3d velocity(double time) const;
};

class Cloth {
 public:
  /// @throws std::invalid_argument if the mesh has defects, the density is not finite and > 0,
  ///   gravity is not finite, particles are tied and the cloth collides with itself, or as
  ///   addFabricForces() and mesh::resolveTies()
  Cloth(mesh::ClothMesh mesh, std::vector<material::Fabric> fabrics,
        const ModelledEffects& effects);
  /// Of one fabric.
  Cloth(mesh::ClothMesh mesh, material::Fabric fabric, const ModelledEffects& effects);

  const mesh::ClothMesh& mesh() const { return mesh_; }
  /// The first one, that of all which is in no region.
  const material::Fabric& fabric() const { return fabrics_.front(); }
  /// All, as the triangles name them (mesh::ClothMesh::fabricOf()).
  const std::vector<material::Fabric>& fabrics() const { return fabrics_; }
  const ModelledEffects& effects() const { return effects_; }
  std::size_t particleCount() const { return masses_.size(); }
  /// Lumped particle masses (kg): a third of each adjacent triangle. Those of tied particles are
  /// with the particles that they are tied to, and theirs are 0.
  const std::vector<double>& masses() const { return masses_; }
  /// All that act, but for contacts: gravity and user-defined forces, fasteners, the fabric's, the
  /// air's, and point loads.
  const ForceSum& forces() const { return *forces_; }
  /// That of the cloth with itself among them; null if it is not modelled.
  const SelfContact* selfContact() const { return self_contact_; }
  /// Those of effects(); null if there are none. Their memory comes first in that of a state.
  const Fasteners* fasteners() const { return fasteners_; }
  /// Which particles are sewn to others. They go with them in every step, act by them, and have no
  /// contacts of their own.
  const Ties& ties() const { return *ties_; }
  /// A matrix with the pattern that the forces are bound to.
  linear::SymmetricBlockMatrix pattern() const;
  /// Of its blocks below the diagonal.
  int patternSize() const { return pattern_size_; }

  /// The state at rest in the initial positions at time 0, tied particles in their places, without
  /// friction in what is bent there.
  ClothState initialState() const;

  /// Changes the first fabric from the next step on: masses and curves, not positions or
  /// velocities. With bending another rigidity may change pattern(): make a new integrator. Where
  /// forces remember, a state of another fabric is refused: forget() first.
  /// @throws std::invalid_argument if the density is not finite and > 0, or as addFabricForces();
  ///   nothing has changed then
  void setFabric(material::Fabric fabric);

  /// Changes all fabrics, gravity (m/s^2) and air from the next step on, likewise.
  /// @throws std::invalid_argument also if there are not as many fabrics as before, or air is given
  ///   where it is not modelled or the other way round; nothing has changed then
  void setMaterial(std::vector<material::Fabric> fabrics, const Eigen::Vector3d& gravity,
                   const std::optional<Air>& air);

  /// Makes the state one without friction in what is bent: the fabric's past is forgotten. What is
  /// fastened stays so; in a state without memory it is as effects() say.
  /// @throws std::invalid_argument if positions or velocities are not as many as particles
  void forget(ClothState& state) const;
  /// Lets what forces remember follow the positions (Force::remember()); what every step does at
  /// its end.
  void remember(ClothState& state) const;

  /// User-defined external force (N) on a particle, until set again; zero at first.
  /// @throws std::invalid_argument if the particle does not exist or the force is not finite
  void setExternalForce(int particle, const Eigen::Vector3d& force);

  /// Replaces the point loads, which act until replaced; none at first. On attached particles they
  /// act as any force: not. Allocates nothing.
  /// @throws std::invalid_argument as PointLoads::set(), or for any if effects() are without them;
  ///   nothing has changed then
  void setPointLoads(const std::vector<PointLoad>& loads);

  /// Replaces the contacts, which hold for steps that end when they say. An implicit step keeps
  /// their particles in their half spaces, with Coulomb friction; an explicit one does not know
  /// them, nor do the functions below. On attached particles they do nothing. Allocates nothing.
  /// @throws std::invalid_argument what requireSound() says, or if effects() are without contacts;
  ///   nothing has changed then
  void setContacts(const std::vector<ParticleContact>& contacts);
  /// The same with rigid bodies, which the step moves (Integrator::bodyMotions()).
  /// @param bodies as many as in reserveBodies(), with no more contacts than there
  void setContacts(const std::vector<ParticleContact>& contacts, const RigidBodies& bodies);
  const std::vector<ParticleContact>& contacts() const { return contacts_; }
  /// How many bodies and contacts of theirs there may be; none at first. An integrator has to be
  /// made after.
  /// @throws std::invalid_argument if effects() are without contacts, or the cloth collides with
  ///   itself
  void reserveBodies(std::size_t bodies, std::size_t contacts);
  const RigidBodies& bodies() const { return bodies_; }

  /// Of a cloth that collides with itself: it collides with these, too, from where they are at time
  /// 0 on. Their friction is the fabric's if they have none. Allocates.
  /// @throws std::invalid_argument if the cloth does not collide with itself
  void setObstacles(std::vector<mesh::Obstacle> obstacles);
  /// They go through a step: ObstacleSurfaces::move(). Nothing without obstacles.
  /// @param begin, end s, simulated
  void moveObstacles(double begin, double end);

  /// Lets open seams close: from this state on each tied particle goes straight to its place beside
  /// the particles that it is tied to, at a speed relative to them, and is sewn once it is there.
  /// Until it is, it is held at what is left of the gap.
  /// @param state that the next step starts from @param speed m/s
  /// @throws std::invalid_argument if the speed is not finite and > 0, or the state's size is not
  ///   the cloth's
  void closeSeams(const ClothState& state, double speed);
  /// The largest distance (m) of a tied particle from its place that is left at a time (s).
  double seamGap(double time) const { return ties_->gapAt(time); }

  /// Attaches a particle to a place, or gives an attached one a new path.
  /// @throws std::invalid_argument if the particle does not exist or is tied, a number is not
  ///   finite, or the duration is negative
  void attach(int particle, const AttachmentPath& path);
  /// @throws std::invalid_argument if attach() would refuse the particle
  void requireAttachable(int particle) const;
  /// @throws std::invalid_argument if the particle does not exist or is not attached
  void release(int particle);
  void releaseAll();
  bool isAttached(int particle) const;
  /// Empty where the particle is free.
  const std::vector<std::optional<AttachmentPath>>& attachments() const { return attachments_; }

  // The functions below throw std::invalid_argument if the state's size is not the cloth's.

  /// All forces() (N) on every particle, not the reaction of an attachment. At rest the reaction at
  /// an attached particle is the negative. Those on tied particles are with the particles that they
  /// are tied to.
  /// @param forces resized to particleCount()
  void computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const;

  /// What all forces() hold (J): elastic energy, that of friction, gravity's and the user-defined
  /// forces' relative to the world origin, the point loads' relative to their positions.
  /// @param pool shares the work if it is given
  double potentialEnergy(const ClothState& state, linear::ThreadPool* pool = nullptr) const;
  double kineticEnergy(const ClothState& state) const;
  Eigen::Vector3d momentum(const ClothState& state) const;  ///< kg m/s, of all particles
  /// Tells whether potentialEnergy() of a state may be another now: a number greater than 0 that no
  /// other cloth has, and that setFabric(), setExternalForce() and setPointLoads()
  /// change.
  std::uint64_t revision() const { return revision_; }

  /// All blocks of the exact (not projected) Jacobian in the rows of the given particles,
  /// sorted by row in the order given, then by column. Tied particles have none, and no column.
  /// @throws std::invalid_argument if a particle does not exist
  std::vector<JacobianBlock> jacobian(const ClothState& state,
                                      const std::vector<int>& particles) const;

 private:
  void takeFabrics(std::vector<material::Fabric> fabrics);
  void requireParticle(int particle) const;
  void requireState(const ClothState& state) const;
  void requireParticles(const ClothState& state) const;

  std::uint64_t revision_;
  mesh::ClothMesh mesh_;
  std::vector<material::Fabric> fabrics_;
  ModelledEffects effects_;
  std::vector<double> masses_;
  std::unique_ptr<Ties> ties_;  // not null
  std::unique_ptr<ForceSum> forces_;
  ConstantForces* constant_ = nullptr;           // of forces_
  const Fasteners* fasteners_ = nullptr;         // of forces_; null if there are none
  PointLoads* point_loads_ = nullptr;            // likewise, if they are not modelled
  SelfContact* self_contact_ = nullptr;          // likewise
  std::shared_ptr<ObstacleSurfaces> obstacles_;  // of self_contact_; null if there are none
  int pattern_size_ = 0;
  std::vector<std::optional<AttachmentPath>> attachments_;
  // Both are empty unless contacts are modelled, and have a capacity of one per particle then.
  std::vector<ParticleContact> contacts_;
  std::vector<char> touched_;  // of setContacts()
  RigidBodies bodies_;         // likewise
};

}  // namespace haptex::cloth
