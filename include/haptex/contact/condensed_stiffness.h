// How a fingertip's force changes when it moves: the contact's stiffness with that of the cloth
// behind it.
#pragma once

#include <Eigen/Core>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/patch.h"

namespace haptex::contact {

/// The contact stiffnesses k of the particles at a fingertip condensed with the step's matrix
/// A = M - h D - h^2 K:
///   S = sum k - h^2 sum k A^-1 k,
/// the change of the fingertip's force when it moves within a step and the other one is held. One
/// direction of one fingertip is computed per step, because each costs a solve, and none that is
/// known already in a step that takes long by itself; so S is six steps old or somewhat more, and
/// is scaled down where the contact has become softer since.
class CondensedStiffness {
 public:
  CondensedStiffness() { clear(); }

  /// After a step of the patch.
  void update(Patch& patch, double h);
  void clear();

  /// -d force / d position of the fingertip (N/m), symmetric, positive semidefinite.
  Eigen::Matrix3d of(base::Finger finger) const;

 private:
  void computeColumn(Patch& patch, double h);

  base::PerFinger<Eigen::Matrix3d> condensed_;
  base::PerFinger<Eigen::Vector3d> known_direct_;  // N/m, direct term's column norms when computed
  base::PerFinger<Eigen::Matrix3d> direct_;        // sum of k now
  int next_ = 0;                                   // 3 times the place in kFingers, plus direction
};

}  // namespace haptex::contact
