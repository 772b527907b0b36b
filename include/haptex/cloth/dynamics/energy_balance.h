// What steps did to the energy of a cloth, beside the work that was done on it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

/// Compares the energies before and after a step: kinetic of the free particles, and
/// Cloth::potentialEnergy(). Work that is done on the cloth may raise their sum: by attachments
/// that move, by the air, by contacts. Forces that resist motion need not be known, they take
/// energy out. Steps in a row share what they take out: one may gain what those before it have
/// lost, of kRemembered at most, as a passivity observer over a window of time allows (Hannaford
/// and Ryu 2002). Nothing allocates after construction.
class EnergyBalance {
 public:
  /// Steps whose losses a later one may gain.
  static constexpr int kRemembered = 10;

  /// @param rates_from_strains the method takes rates of strain from strains, not from velocities,
  ///   and so does the work of attachments
  /// @param pool shares the work if it is given; has to outlive this
  explicit EnergyBalance(const Cloth& cloth, bool rates_from_strains = false,
                         linear::ThreadPool* pool = nullptr);

  /// Before the step. What was lost before is forgotten unless the step goes on from the state of
  /// the last keep(). @param begin that the step starts from
  void begin(const Cloth& cloth, const ClothState& begin);

  /// Energy (J) that the cloth has at the end beyond the most that it had at the beginning of this
  /// step and of the remembered ones, and what was done on it since; at most 0 if there is none.
  /// NaN or infinite if an energy is.
  ///
  /// The work of attachments is that of their forces at the end of the step, as it is in backward
  /// Euler, or of the mean of those at both ends, as it is to the second order, if that is more;
  /// but no more than that of a jump at the beginning of the step. That of the air is its power at
  /// the beginning or the end, whichever is more. That of contacts is of their forces over the ways
  /// of the bodies and out of what they had penetrated, that of obstacles of a cloth that collides
  /// with itself what SelfContact::obstacleWork() says. That of closing seams is of the forces on
  /// the tied particles at the beginning or the end, whichever is more, over the way of the gaps.
  /// @param begin as for begin()
  /// @param end   its time included
  /// @param reactions in the order of Cloth::contacts(); empty: none acted
  double excess(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                const std::vector<ContactReaction>& reactions);

  /// The cloth goes on from the state of the last excess(), of whose kinetic energy `taken` (J) was
  /// taken out since. Its potential energy need not be computed again if the cloth stays as it is.
  void keep(const Cloth& cloth, const ClothState& end, double taken);

  /// It has to, because something else than a step has changed it since.
  void forgetPotential() { revision_ = 0; }

  /// Kinetic energy (J) of the free particles at the end, of the last excess().
  double kineticAtEnd() const { return kinetic_end_; }

 private:
  double growth(const Cloth& cloth, const ClothState& begin, const ClothState& end,
                const std::vector<ContactReaction>& reactions);
  double reserve() const;
  void forget();
  double attachmentWork(const Cloth& cloth, const ClothState& begin, const ClothState& end);
  double closingWork(const Cloth& cloth, const ClothState& begin, const ClothState& end);
  void computeForces(const Cloth& cloth, const ClothState& at, const StrainPast& past);
  double drivenPower(const Cloth& cloth, const ClothState& state);

  double potential_begin_ = 0.0;
  double potential_end_ = 0.0;
  double potential_kept_ = 0.0;
  double kinetic_begin_ = 0.0;
  double kinetic_end_ = 0.0;
  double growth_ = 0.0;                     // J, of the step
  std::uint64_t revision_ = 0;              // of the cloth whose potential energy was kept
  std::array<double, kRemembered> lost_{};  // J, since the beginnings of the last steps
  int remembered_ = 0;
  int next_ = 0;
  linear::ThreadPool* pool_;
  bool rates_from_strains_;
  Positions last_positions_;
  std::vector<Eigen::Vector3d> forces_;
  ClothState jumped_;
};

}  // namespace haptex::cloth
