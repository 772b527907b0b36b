// How a fingertip's force changes when fingertips move: the contact's stiffness with that of the
// cloth behind it.
#pragma once

#include <Eigen/Core>

#include "haptex/cloth/block_matrix.h"
#include "haptex/contact/fingertip.h"
#include "haptex/contact/patch.h"

namespace haptex::contact {

/// The particles' contact stiffnesses k condensed with the step's matrix A = M - h D - h^2 K:
///   S_fg = sum_f k - h^2 sum_f k A^-1 k_g  (the first term only for f = g),
/// the change of the force on fingertip f when fingertip g moves within a step. One direction of
/// one fingertip is computed per step, because each costs a solve; so S is up to six steps old, and
/// is scaled down where the contact has become softer since.
class CondensedStiffness {
 public:
  /// @param most_particles of the patches to come
  explicit CondensedStiffness(std::size_t most_particles);

  /// After a step of the patch.
  void update(Patch& patch, double h);
  void clear();

  /// -d force of the fingertip / d its position, the other held (N/m).
  Eigen::Matrix3d own(int fingertip) const;
  /// -d force of the fingertip / d position of both, which is what it feels of a movement of the
  /// whole cloth (N/m).
  Eigen::Matrix3d common(int fingertip) const;

 private:
  void computeColumn(Patch& patch, double h);

  PerFingertip<PerFingertip<Eigen::Matrix3d>> blocks_;
  PerFingertip<Eigen::Vector3d> known_direct_;  // N/m, direct term's column norms when computed
  PerFingertip<Eigen::Matrix3d> direct_;        // sum of k now
  int next_ = 0;                                // 3 fingertip + direction
  cloth::BlockVector column_;
};

}  // namespace haptex::contact
