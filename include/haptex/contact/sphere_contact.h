// Contact of one fingertip with the particles of a cloth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/contact/contact_law.h"
#include "haptex/contact/fingertip.h"

namespace haptex::contact {

/// The particles that may be touched. World frame; `areas` at rest (m^2), a third of every adjacent
/// triangle.
struct Particles {
  const std::vector<Eigen::Vector3d>& positions;   ///< m
  const std::vector<Eigen::Vector3d>& velocities;  ///< m/s
  const std::vector<double>& areas;                ///< m^2
  int count;                                       ///< only the first so many
  /// Layers of cloth between the fingertip and each particle; null: none anywhere.
  const std::vector<double>* layers_before = nullptr;
};

/// A particle in contact.
struct TouchedParticle {
  int particle;
  Eigen::Vector3d normal;    ///< unit, from the fingertip's centre
  double depth;              ///< m, > 0
  double normal_force;       ///< N, >= 0
  Eigen::Vector3d friction;  ///< N, on the particle
  bool slips;
  /// -d force / d position (N/m) and -d force / d velocity (N.s/m), symmetric, positive
  /// semidefinite. `stiffness` is that of a step, in which a particle that slips is held by the
  /// secant of its friction; in `tangent` its friction is constant along the slip.
  Eigen::Matrix3d stiffness;
  Eigen::Matrix3d tangent;
  Eigen::Matrix3d damping;

  Eigen::Vector3d force() const { return normal_force * normal + friction; }  ///< N
};

/// Completes a contact that has all but friction: holds it by a spring to its anchor, that gives
/// way where it would pull with more than the coefficient times the normal force (Coulomb friction
/// by return mapping: Simo and Hughes 1998, chapter 1).
/// @param offset   m, of the particle from its anchor, of which the part along the surface counts
/// @param sticking N/m, > 0
void addFriction(const Eigen::Vector3d& offset, double sticking, double coefficient,
                 TouchedParticle& contact);

/// Every particle deeper than zero is pushed out along the line from the fingertip's centre with
/// the pressure of the contact law times its area, and held by friction: a spring to an anchor on
/// the turning fingertip, that is dragged along when it slips (addFriction()). Nothing allocates
/// after the constructor.
class SphereContact {
 public:
  /// @param most_particles that will ever be asked about
  SphereContact(const ContactLaw& law, std::size_t most_particles);
  /// @param laws    of the cloth's fabrics, at least one; kept
  /// @param fabrics of the particles; empty: all are of the first
  SphereContact(const std::vector<ContactLaw>& laws, std::vector<std::uint8_t> fabrics,
                std::size_t most_particles);

  /// Touched particles and their forces, with the anchors as they are.
  const std::vector<TouchedParticle>& evaluate(const Particles& particles,
                                               const Fingertip& fingertip);
  /// The same, then moves the anchors: of new contacts here, of those that slip along, of those
  /// that have ended away.
  const std::vector<TouchedParticle>& commit(const Particles& particles,
                                             const Fingertip& fingertip);
  /// Forgets all contacts.
  void clear();
  /// Of the last evaluate(), commit() or clear().
  const std::vector<TouchedParticle>& touched() const { return touched_; }

  /// Takes over the anchor of a particle of another contact.
  void adoptAnchor(int particle, const SphereContact& other, int other_particle);

 private:
  struct Anchor {
    Eigen::Vector3d place;  // m, in the fingertip's frame
    bool holds = false;
  };
  bool touch(int particle, const Particles& particles, const Fingertip& fingertip,
             TouchedParticle& result) const;

  const ContactLaw& lawOf(int particle) const {
    return laws_[fabrics_.empty() ? 0 : fabrics_[particle]];
  }

  const ContactLaw* laws_;
  std::vector<std::uint8_t> fabrics_;
  std::vector<Anchor> anchors_;
  std::vector<TouchedParticle> touched_;
};

}  // namespace haptex::contact
