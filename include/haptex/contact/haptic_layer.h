// The small-scale layer: the cloth around the fingertips at 1 kHz, and the forces between them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/contact/condensed_stiffness.h"
#include "haptex/contact/contact_law.h"
#include "haptex/contact/fingertip.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/contact/held_fingertip.h"
#include "haptex/contact/large_scale_motion.h"
#include "haptex/contact/obstacles/obstacle_contact.h"
#include "haptex/contact/patch.h"
#include "haptex/contact/patch_selection.h"
#include "haptex/contact/whole_cloth_contact.h"

namespace haptex::contact {

/// @throws std::invalid_argument if the fabric lacks a property that contact needs: friction,
///   compression; bending for a patch
void requireTouchable(const material::Fabric& fabric, const HapticSettings& settings);

/// Where a fingertip touches a particle of the layer.
struct ContactPoint {
  Eigen::Vector3d position;          ///< m, of the particle, world frame
  Eigen::Vector3d normal;            ///< unit, from the fingertip's centre to the particle
  double normal_force;               ///< N, >= 0
  Eigen::Vector3d tangential_force;  ///< N, on the cloth
};

/// What one fingertip feels after a step. World frame. The force is the cloth's on the fingertip:
///   force(p, v) = force - stiffness (p - position) - damping (v - velocity)
/// While the cloth holds the fingertip (HeldFingertip) the force is that of where it is held, and
/// stiffness and damping are zero.
struct FingertipContact {
  bool touching = false;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();      ///< N
  Eigen::Vector3d position = Eigen::Vector3d::Zero();   ///< m, where the person has it
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< m/s, likewise
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, symmetric, positive semidefinite
  Eigen::Matrix3d damping = Eigen::Matrix3d::Zero();    ///< N.s/m, likewise

  // For the tactile renderer and for the eye. Zero without contact.
  double area = 0.0;          ///< m^2, at rest, of the cloth that is touched
  double normal_force = 0.0;  ///< N, sum of the magnitudes over the contact points
  double penetration = 0.0;   ///< m, deepest
  bool slipping = false;      ///< at least half of the normal force is on points that slip
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();            ///< m, of pressure
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();            ///< unit, mean, out of the fingertip
  Eigen::Vector3d sliding_velocity = Eigen::Vector3d::Zero();  ///< m/s, fingertip over cloth
  /// Which of the cloth's fabrics is touched: that on which most of the normal force is.
  int fabric = 0;
  /// m, centre in (weft, warp), of the panel that takes most of the normal force.
  Eigen::Vector2d fabric_position = Eigen::Vector2d::Zero();
  Eigen::Vector2d fabric_velocity = Eigen::Vector2d::Zero();  ///< m/s, sliding in (weft, warp)
  /// How (weft, warp) change with the place along the cloth in the world frame, no unit.
  Eigen::Matrix<double, 2, 3> to_fabric = Eigen::Matrix<double, 2, 3>::Zero();
  std::vector<ContactPoint> points;  ///< at most kMaxContactPoints
};

/// The cloth around the fingertips, refined and stepped at 1 kHz between the states of the
/// large-scale layer, and its contact with the fingertips.
///
/// One thread, the fast one, calls receive(), exchange() and step(); these allocate nothing.
/// Another one may call preparePatch() at the same time.
class HapticLayer {
 public:
  static constexpr std::size_t kMaxContactPoints = 1024;

  /// @param mesh, fabrics, effects those of the large-scale layer; at most mesh::kMostFabrics
  /// @param obstacles of the scene; patches touch those without mass if effects has contacts
  /// @throws std::invalid_argument what requireTouchable(), cloth::Cloth or PlacedObstacles throws,
  ///   or if the mesh has ties, or a triangle a fabric that is not there
  HapticLayer(mesh::ClothMesh mesh, std::vector<material::Fabric> fabrics,
              const cloth::ModelledEffects& effects, const HapticSettings& settings,
              std::vector<mesh::Obstacle> obstacles = {});
  /// Of one fabric.
  HapticLayer(mesh::ClothMesh mesh, material::Fabric fabric, const cloth::ModelledEffects& effects,
              const HapticSettings& settings, std::vector<mesh::Obstacle> obstacles = {});
  // Its patches refer to its contact law and its obstacles.
  HapticLayer(const HapticLayer&) = delete;
  HapticLayer& operator=(const HapticLayer&) = delete;

  const HapticSettings& settings() const { return settings_; }
  /// Of one of the cloth's fabrics.
  const ContactLaw& law(int fabric = 0) const { return laws_[fabric]; }

  /// Cuts the elements out of the mesh and refines them; does all that needs memory or long.
  /// Constant: any thread.
  /// @param triangles of the large-scale mesh, in any order, repetition allowed; may be empty
  /// @param attached  one per large-scale particle, nonzero where it is held
  /// @param around    others that come into the patch and stay as they are
  /// @returns null if there are no triangles
  /// @throws std::invalid_argument if a triangle does not exist or `attached` has another size
  std::unique_ptr<Patch> preparePatch(const std::vector<int>& triangles,
                                      const std::vector<char>& attached,
                                      const std::vector<int>& around = {}) const;
  /// What the patch of a pinch has around some triangles: contact::elementsAround(), nothing if the
  /// cloth collides with itself, because its layers would fall through each other there.
  std::vector<int> elementsAround(const std::vector<int>& triangles, double reach) const;

  /// A state of the large-scale layer. From now on the layer moves from where it is to this state
  /// within `period`, so it follows one period behind, and never jumps.
  /// @param period s, of simulated time since the last state; > 0
  /// @param time s, simulated, of the state: obstacles that move are where they were then
  /// @throws std::invalid_argument if the sizes differ from the mesh or a number is not finite;
  ///   nothing has changed then
  void receive(const std::vector<Eigen::Vector3d>& positions,
               const std::vector<Eigen::Vector3d>& velocities, double period, double time = 0.0);

  /// Goes on with another patch: particles that both have keep their state, others come from the
  /// large-scale state; forces do not jump.
  /// @param next null: no patch
  /// @returns the one before, to be destroyed where time does not matter
  std::unique_ptr<Patch> exchange(std::unique_ptr<Patch> next);

  /// Advances by settings().time_step. A fingertip that is absent, or not sound, does not touch.
  /// Without a state yet there is no contact.
  void step(const Fingertips& fingertips);

  /// False if the last step was not finite: the layer has then started again from the large-scale
  /// state, and the forces are zero.
  bool lastStepAccepted() const { return last_step_accepted_; }
  std::size_t particleCount() const { return patch_ ? patch_->particleCount() : 0; }
  const Patch* patch() const { return patch_.get(); }

  /// Where the fingertips of the last step are in contact; they differ from where the person has
  /// them where the cloth holds them (HeldFingertip).
  const std::optional<Fingertip>& held(base::Finger finger) const { return held_[finger].held(); }
  const base::PerFinger<FingertipContact>& contacts() const { return contacts_; }
  /// Whether the fingertips press on the cloth from opposite sides, so that a hand may carry it.
  bool isPinched() const;
  /// What acts on the large-scale cloth, see cloth::Cloth::setPointLoads().
  const std::vector<cloth::PointLoad>& loads() const { return loads_; }

 private:
  void hold(const Fingertips& fingertips);
  void stepPatch();
  void stepWholeCloth();
  void startAgain();
  int fabricOf(int particle) const;
  int fabricUnder(const std::vector<TouchedParticle>& touched) const;
  void fillContact(base::Finger finger, const std::vector<TouchedParticle>& touched,
                   const Particles& particles);
  template <typename RestOf, typename LoadOf>
  void sendBack(FingertipContact& contact, const std::vector<TouchedParticle>& touched,
                const RestOf& rest_of, const LoadOf& load_of);
  Eigen::Vector3d aheadOf(base::Finger finger, const Eigen::Matrix3d& stiffness) const;
  double followingSpeed(base::Finger finger) const;

  HapticSettings settings_;
  mesh::ClothMesh mesh_;
  std::vector<material::Fabric> fabrics_;
  cloth::ModelledEffects effects_;
  std::vector<ContactLaw> laws_;  // of the fabrics
  PlacedObstacles obstacles_;
  MeshTopology topology_;
  LargeScaleMotion motion_;
  std::vector<double> panel_forces_;  // parts of a contact's normal force; scratch
  std::unique_ptr<Patch> patch_;
  CondensedStiffness stiffness_;
  std::unique_ptr<WholeClothContact> whole_cloth_;  // null with patches
  Fingertips fingertips_;                           // where the person has them
  base::PerFinger<HeldFingertip> held_;
  base::PerFinger<const Fingertip*> present_{};  // into held_
  // m, at the last two states of the large-scale layer.
  base::PerFinger<std::array<std::optional<Eigen::Vector3d>, 2>> places_at_states_;
  base::PerFinger<FingertipContact> contacts_;
  std::vector<cloth::PointLoad> loads_;
  bool last_step_accepted_ = true;
};

}  // namespace haptex::contact
