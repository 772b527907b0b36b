#include "haptex/contact/condensed_stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace haptex::contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The nearest symmetric positive semidefinite matrix (Frobenius norm).
Matrix3d positivePart(const Matrix3d& matrix) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(0.5 * (matrix + matrix.transpose()));
  const Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

void CondensedStiffness::clear() {
  for (int f = 0; f < kFingertips; ++f) {
    condensed_[f].setZero();
    known_direct_[f].setZero();
    direct_[f].setZero();
  }
}

void CondensedStiffness::update(Patch& patch, double h) {
  for (int f = 0; f < kFingertips; ++f) {
    direct_[f].setZero();
    for (const TouchedParticle& touched : patch.linearised(f)) direct_[f] += touched.tangent;
    if (!patch.linearised(f).empty()) continue;
    condensed_[f].setZero();
    known_direct_[f].setZero();
  }
  // The next direction of a fingertip that touches.
  for (int tried = 0; tried < 3 * kFingertips; ++tried) {
    next_ = (next_ + 1) % (3 * kFingertips);
    if (!patch.linearised(next_ / 3).empty()) {
      computeColumn(patch, h);
      return;
    }
  }
}

void CondensedStiffness::computeColumn(Patch& patch, double h) {
  const int f = next_ / 3;
  const int direction = next_ % 3;
  const linear::BlockVector& solution = patch.respond(f, direction);
  Vector3d change = direct_[f].col(direction);
  for (const TouchedParticle& touched : patch.linearised(f)) {
    change -= h * h * touched.tangent * solution.col(touched.particle);
  }
  condensed_[f].col(direction) = change;
  known_direct_[f][direction] = direct_[f].col(direction).norm();
}

Matrix3d CondensedStiffness::of(int f) const {
  double scale = 1.0;
  for (int direction = 0; direction < 3; ++direction) {
    const double now = direct_[f].col(direction).norm();
    if (now < known_direct_[f][direction]) {
      scale = std::min(scale, now / known_direct_[f][direction]);
    }
  }
  return scale * positivePart(condensed_[f]);
}

}  // namespace haptex::contact
