// A fingertip that the cloth holds on the side that it came from.
#pragma once

#include <optional>
#include <vector>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/sphere_contact.h"

namespace haptex::contact {

/// Where a fingertip is in contact, which is where the person has it unless cloth holds it. Its
/// core, a sphere of what is left when pulp and fabric are compressed by kDeepest of the radius, is
/// swept from where it was to where it is to be, and stops at the particles that it meets; from
/// there it slides along the cloth if it is drawn by more than friction holds, and goes back with
/// cloth that comes back. Held so, the force no longer grows, which on flat cloth it would not do
/// from there on in any case (2 pi z integral of the pressure, largest at a depth of 2/3 of the
/// radius), and keeps pushing the fingertip back to the side that it came from, until it is there,
/// or kLongest away from where it is held: then the cloth lets go.
///
/// Only the particles that were touched can be met by the core, unless it moves by more than
/// kDeepest of the radius at once. Nothing allocates.
class HeldFingertip {
 public:
  static constexpr double kDeepest = 2.0 / 3.0;  ///< of the radius
  static constexpr double kLongest = 0.1;        ///< m

  /// Goes on to the next fingertip.
  /// @param particles that it may meet, with their velocities
  /// @param touched   those that it touched in the last step
  /// @param reach     m, from the fingertip's centre to a particle that it just touches
  /// @param friction  coefficient, of the fabric on the fingertip
  /// @return it, or held
  const Fingertip& move(const Fingertip& next, const Particles& particles,
                        const std::vector<TouchedParticle>& touched, double reach, double friction);
  /// Where there was no cloth around it: it is where the person has it.
  const Fingertip& follow(const Fingertip& next);
  /// There are other particles now: the next move() looks at all.
  /// @param place m, earlier, from where it is to look for them: nobody had asked yet for the cloth
  ///   on its way from there. Not of one that is held. None: from where it is.
  void sweepFrom(const std::optional<Eigen::Vector3d>& place);
  /// It is away; the next one is not swept.
  void clear() {
    held_.reset();
    is_held_ = false;
  }

  const std::optional<Fingertip>& held() const { return held_; }
  bool isHeld() const { return is_held_; }

 private:
  std::optional<Fingertip> held_;
  bool sweeps_all_ = false;
  bool is_held_ = false;
};

}  // namespace haptex::contact
