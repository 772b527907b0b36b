#include "haptex/contact/condensed_stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace haptex::contact {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kColumns = 3 * static_cast<int>(kFingers.size());

/// The nearest symmetric positive semidefinite matrix (Frobenius norm).
Matrix3d positivePart(const Matrix3d& matrix) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(0.5 * (matrix + matrix.transpose()));
  const Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

void CondensedStiffness::clear() {
  for (const Finger finger : kFingers) {
    condensed_[finger].setZero();
    known_direct_[finger].setZero();
    direct_[finger].setZero();
  }
}

void CondensedStiffness::update(Patch& patch, double h) {
  for (const Finger finger : kFingers) {
    direct_[finger].setZero();
    for (const TouchedParticle& touched : patch.linearised(finger))
      direct_[finger] += touched.tangent;
    if (!patch.linearised(finger).empty()) continue;
    condensed_[finger].setZero();
    known_direct_[finger].setZero();
  }
  // The next direction of a fingertip that touches. Where one is known already it can wait until a
  // step leaves time.
  for (int tried = 1; tried <= kColumns; ++tried) {
    const int next = (next_ + tried) % kColumns;
    const Finger finger = kFingers[next / 3];
    if (patch.linearised(finger).empty()) continue;
    if (known_direct_[finger][next % 3] > 0.0 && !patch.stepWasShort()) return;
    next_ = next;
    computeColumn(patch, h);
    return;
  }
}

void CondensedStiffness::computeColumn(Patch& patch, double h) {
  const Finger finger = kFingers[next_ / 3];
  const int direction = next_ % 3;
  const linear::BlockVector& solution = patch.respond(finger, direction);
  Vector3d change = direct_[finger].col(direction);
  for (const TouchedParticle& touched : patch.linearised(finger)) {
    change -= h * h * touched.tangent * solution.col(touched.particle);
  }
  condensed_[finger].col(direction) = change;
  known_direct_[finger][direction] = direct_[finger].col(direction).norm();
}

Matrix3d CondensedStiffness::of(Finger finger) const {
  double scale = 1.0;
  for (int direction = 0; direction < 3; ++direction) {
    const double now = direct_[finger].col(direction).norm();
    if (now < known_direct_[finger][direction]) {
      scale = std::min(scale, now / known_direct_[finger][direction]);
    }
  }
  return scale * positivePart(condensed_[finger]);
}

}  // namespace haptex::contact
