// What a step did to the energy of a cloth, beside the work that was done on it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/cloth/cloth.h"

namespace haptex::cloth {

/// Compares the energies before and after a step: kinetic of the free particles, and
/// Cloth::potentialEnergy(). Work that is done on the cloth may raise their sum: by attachments
/// that move, by the air, by contacts. Forces that resist motion need not be known, they take
/// energy out. Nothing allocates after construction.
class EnergyBalance {
 public:
  explicit EnergyBalance(const Cloth& cloth);

  /// Before the step. @param begin that the step starts from
  void begin(const Cloth& cloth, const ClothState& begin);

  /// Energy (J) that the cloth has at the end beyond what it had and what was done on it; at most 0
  /// if the step has gained none. NaN or infinite if an energy is.
  ///
  /// The work of attachments is that of their forces at the end of the step, as it is in backward
  /// Euler, or of the mean of those at both ends, as it is to the second order, if that is more;
  /// but no more than that of a jump at the beginning of the step. That of the air is its power at
  /// the beginning or the end, whichever is more. That of contacts is of their forces over the way
  /// of their particles.
  /// @param begin as for begin()
  /// @param end   its time included
  /// @param reactions in the order of Cloth::contacts(); empty: none acted
  double growth(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                const std::vector<ContactReaction>& reactions);

  /// The cloth goes on from the state of the last growth(), whose potential energy need not be
  /// computed again if the cloth stays as it is.
  void keep(const Cloth& cloth, const ClothState& end);

  /// Kinetic energy (J) of the free particles at the end, of the last growth().
  double kineticAtEnd() const { return kinetic_end_; }

 private:
  double attachmentWork(const Cloth& cloth, const ClothState& begin, const ClothState& end);
  double airPower(const Cloth& cloth, const ClothState& state);

  double potential_begin_ = 0.0;
  double potential_end_ = 0.0;
  double kinetic_begin_ = 0.0;
  double kinetic_end_ = 0.0;
  std::uint64_t revision_ = 0;  // of the cloth whose potential energy at the end is known
  Positions last_positions_;
  std::vector<Eigen::Vector3d> forces_;
  ClothState jumped_;
};

}  // namespace haptex::cloth
