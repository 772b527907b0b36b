// A piece of the large-scale cloth, refined and simulated at a high rate.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/forces/force_sum.h"
#include "haptex/contact/fingertip.h"
#include "haptex/contact/large_scale_motion.h"
#include "haptex/contact/layers_between.h"
#include "haptex/contact/obstacles/obstacle_contact.h"
#include "haptex/contact/patch_forces.h"
#include "haptex/contact/patch_solver.h"
#include "haptex/contact/refined_cut.h"
#include "haptex/contact/sphere_contact.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::contact {

/// Membrane with the fabric's curves, bending, gravity, and contact with fingertips and obstacles
/// on the triangles of a refined cut. The rim follows the large-scale cloth; the rest is stepped by
/// linearised backward Euler. The matrix is that of the step; the factor that helps to solve with
/// it is kept over several (PatchSolver).
///
/// The constructor does all that needs memory; the other functions allocate nothing.
class Patch {
 public:
  /// @param coarse  the mesh that was cut
  /// @param fabrics of the cloth, with bending
  /// @param laws    of each, for LayersBetween::kMost layers if effects are with self_collision,
  ///   between which the layers of a pinch count as of the fabric that is pushed; kept
  /// @param obstacles where they are at the end of each step; null: none
  Patch(const mesh::ClothMesh& coarse, RefinedCut cut, const std::vector<material::Fabric>& fabrics,
        const cloth::ModelledEffects& effects, const std::vector<ContactLaw>& laws,
        const PlacedObstacles* obstacles = nullptr);

  std::size_t particleCount() const { return state_.positions.size(); }
  int freeCount() const { return cut_.free_count; }
  const std::vector<Eigen::Vector3d>& positions() const { return state_.positions; }  ///< m, world
  const std::vector<std::array<int, 3>>& triangles() const { return cut_.mesh.triangles; }
  /// Magnitude of the contact force on every particle (N).
  const std::vector<double>& contactForces() const { return contact_forces_; }
  const RefinedCut& cut() const { return cut_; }
  /// Which of the cloth's fabrics a particle is of.
  int fabricOf(int particle) const { return cut_.fabrics.empty() ? 0 : cut_.fabrics[particle]; }

  /// Puts every particle to its place on the large-scale cloth, at rest, without contact.
  void start(const LargeScaleMotion& motion);
  /// Starts, but goes on with the state of all particles that another patch has too. If that one
  /// is in contact, what becomes free or rim lets go of where it was gradually, so that forces do
  /// not jump.
  void goOnFrom(const Patch& other, const LargeScaleMotion& motion);

  /// One step.
  /// @param motion     already at the end of the step
  /// @param fingertips at the end of the step; null: absent
  /// @param h          s
  /// @returns false if the system could not be solved or the result is not finite; start() again
  bool advance(const LargeScaleMotion& motion, const base::PerFinger<const Fingertip*>& fingertips,
               double h);

  /// Forces and anchors at the end of the last step.
  const SphereContact& contact(base::Finger finger) const { return contacts_[finger]; }
  /// What the last step was linearised with.
  const std::vector<TouchedParticle>& linearised(base::Finger finger) const {
    return linearised_[finger];
  }
  /// The place of a particle on the large-scale cloth (m).
  Eigen::Vector3d placeOnCloth(int particle, const LargeScaleMotion& motion) const;
  /// m, along weft and warp, in the panel of the particle's owner.
  const Eigen::Vector2d& restCoordinates(int particle) const {
    return cut_.mesh.rest_coordinates[particle];
  }
  const std::vector<Eigen::Vector3d>& velocities() const { return state_.velocities; }
  /// Per particle, at rest (m^2); where layers of cloth that collides with itself lie on each other
  /// in a pinch, over their number (LayersBetween).
  const std::vector<double>& areas() const { return layers_ ? layers_->areas() : areas_; }
  /// What a fingertip may touch.
  Particles particles(base::Finger finger) const { return particlesAt(state_.positions, finger); }

  /// A^-1 k e with the matrix A = M - h D - h^2 K of the last step: k are the contact stiffnesses
  /// of the particles at a fingertip, e the unit vector of a direction (0 to 2).
  /// One iteration better than the last time, if that was for a matrix and contact close to these.
  /// @returns 3 x freeCount(), until the next call
  const linear::BlockVector& respond(base::Finger finger, int direction);

  /// Whether some particle touched an obstacle in the last step.
  bool touchesObstacle() const { return obstacles_ && !obstacles_->touched().empty(); }

  /// Whether the last step took few iterations, so that there is time for a respond().
  bool stepWasShort() const { return solver_.wasShort(); }

 private:
  Patch(const mesh::ClothMesh& coarse, RefinedCut& cut,
        const std::vector<material::Fabric>& fabrics, const cloth::ModelledEffects& effects,
        const std::vector<ContactLaw>& laws, const PlacedObstacles* obstacles, PatchForces forces);
  Particles particlesAt(const std::vector<Eigen::Vector3d>& positions, base::Finger finger) const;
  Particles atObstacles(const std::vector<Eigen::Vector3d>& positions) const;
  bool placeOn(const Patch& other, int particle, const LargeScaleMotion& motion);
  void tie(int particle, const LargeScaleMotion& motion, double h);
  void assemble(const LargeScaleMotion& motion, double h);
  bool solve(double h);
  void add(const TouchedParticle& touched, double h);
  void addContact(const base::PerFinger<const Fingertip*>& fingertips, double h);

  RefinedCut cut_;
  std::vector<std::array<int, 3>> corners_;  // per particle: those of its owner
  cloth::ModelledEffects effects_;
  cloth::ForceSum forces_;
  std::vector<double> areas_;            // m^2, per particle
  std::vector<double> masses_;           // kg
  std::optional<LayersBetween> layers_;  // of cloth that collides with itself
  std::optional<ObstacleContact> obstacles_;
  linear::SymmetricBlockMatrix matrix_;
  PatchSolver solver_;

  cloth::ClothState state_;
  std::vector<Eigen::Vector3d> predicted_;  // m
  std::vector<Eigen::Vector3d> detours_;    // m, from the place on the cloth; fade
  std::vector<double> ties_;                // N/m, likewise, of what stays coarse
  std::vector<double> tethers_;             // N/m, to that place; fade
  base::PerFinger<SphereContact> contacts_;
  base::PerFinger<std::vector<TouchedParticle>> linearised_;
  std::vector<double> contact_forces_;
  linear::BlockVector rhs_;
  linear::BlockVector solution_;
  base::PerFinger<std::array<linear::BlockVector, 3>> responses_;  // by direction
};

}  // namespace haptex::contact
