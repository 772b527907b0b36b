// Contacts of particles with rigid bodies: half spaces that a step keeps them in.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace haptex::cloth {

/// A half space that bounds where a particle may be, and that may move. World frame. At the time t
/// of the step from `end` - h to `end` the particle keeps
///   normal . (x - place(t)) >= -gap,  place(t) = place + (t - end) velocity.
struct ParticleContact {
  int particle;
  Eigen::Vector3d normal;    ///< unit, away from the body
  Eigen::Vector3d place;     ///< m, where the particle would be at `end` if it stuck to the body
  double gap;                ///< m, how far `place` is inside the half space; < 0: outside
  Eigen::Vector3d velocity;  ///< m/s, of the body there
  double friction;           ///< Coulomb's coefficient, >= 0
  double end;                ///< s, simulated
  /// Of RigidBodies, whose predicted velocity is in `place` and `velocity`: it goes as the contacts
  /// push it. -1: none, the body moves as it wants.
  int body = -1;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< m, from that body's centre to the contact
};

/// What a contact did in the last stage of a step.
struct ContactReaction {
  enum class State {
    kOpen,    ///< nothing: the particle stayed off
    kSlips,   ///< holds it in the half space, friction at its limit
    kSticks,  ///< holds it altogether
  };
  State state = State::kOpen;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< N, on the particle
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, of the body there
};

/// @param particles one entry per particle of the cloth, overwritten
/// @param bodies    that there are
/// @throws std::invalid_argument naming the contact if its particle does not exist or has an
///   earlier one, a number is not finite, the normal is not of unit length within 1e-6, or the
///   friction is negative, or the body does not exist
void requireSound(const std::vector<ParticleContact>& contacts, std::vector<char>& particles,
                  std::size_t bodies = 0);

}  // namespace haptex::cloth
