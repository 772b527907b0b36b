// A contact while the linear systems of a stage are solved: what it does, and the law that it
// obeys.
#pragma once

#include <Eigen/Core>

#include "haptex/cloth/dynamics/particle_contact.h"

namespace haptex::cloth {

/// What the next stage starts from, of a contact that is there again.
struct ContactMemory {
  ContactReaction::State state = ContactReaction::State::kOpen;
  double load = 0.0;                               ///< N, normal
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();  ///< m/s, that friction is linearised at
  long stage = -1;                                 ///< in which it was
};

struct HeldContact : ContactMemory {
  int contact;             ///< of the cloth
  int particle;            ///< of that contact
  Eigen::Vector3d normal;  ///< of that contact
  Eigen::Vector3d body;    ///< m/s, its velocity
  Eigen::Vector3d target;  ///< m/s, of a particle that goes with the body and closes the gap
  int rigid = -1;          ///< number of the contact's rigid body; -1: none, without the next four
  double mass = 0.0;       ///< kg, of the particle
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();               ///< of that contact
  Eigen::Vector3d predicted_body = Eigen::Vector3d::Zero();    ///< m/s, as the body was predicted
  Eigen::Vector3d predicted_target = Eigen::Vector3d::Zero();  ///< m/s, likewise
  double friction;
  bool fresh = false;  ///< the next round begins with another constraint
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, of the last round
  Eigen::Vector3d ratio = Eigen::Vector3d::Zero();   ///< friction over normal force of what slips
  Eigen::Vector3d before = Eigen::Vector3d::Zero();  ///< N, of the system before
  Eigen::Vector3d change = Eigen::Vector3d::Zero();  ///< m/s, of the slip, in the last round
};

/// The motion of the particle relative to the half space that bounds it.
struct RelativeMotion {
  double gap;            ///< m/s, along the normal; < 0: it enters
  Eigen::Vector3d slip;  ///< m/s, across
};
RelativeMotion relativeMotion(const HeldContact& contact, const Eigen::Vector3d& velocity);

/// Friction (N) at a slip (m/s) under a normal force (N): mu N against the slip, and in proportion
/// to it up to `smoothing` m/s > 0.
Eigen::Vector3d frictionAt(const HeldContact& contact, const Eigen::Vector3d& slip, double load,
                           double smoothing);
/// Its negative derivative by the slip at the contact's, N.s/m; positive semidefinite.
Eigen::Matrix3d frictionResistance(const HeldContact& contact, double smoothing);

/// What is entered closes: it sticks if it comes steeper than the cone, or else slips as it does
/// (the map of Alart and Curnier of a contact without force).
void close(const RelativeMotion& motion, HeldContact& contact);

/// What the contact does in the next round, by its force and velocity in this one: opens if it
/// pulls, closes if it goes farther than a nanometre into the body, slips if it needs more than
/// mu N.
/// @param a s, of the stage
void judge(const Eigen::Vector3d& velocity, double a, double smoothing, HeldContact& contact);

/// Brings the force into the cone: none if it pulls, friction of mu N at most.
void bringIntoCone(HeldContact& contact);

/// Farther than this (m) a particle is not let into a body.
constexpr double kContactPenetration = 1e-9;

}  // namespace haptex::cloth
