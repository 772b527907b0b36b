#include "haptex/cloth/dynamics/rigid_bodies.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kMostSweeps = 1000;
constexpr double kConverged = 1e-12;  // change of a velocity in a sweep, of the fastest
constexpr double kStill = 1e-15;      // m/s, likewise where nothing moves

/// Three columns of twists that impulses along the axes make.
Eigen::Matrix<double, 6, 3> impulsesAt(const Vector3d& arm) {
  Eigen::Matrix<double, 6, 3> columns;
  for (int axis = 0; axis < 3; ++axis) columns.col(axis) = impulseAt(Vector3d::Unit(axis), arm);
  return columns;
}

}  // namespace

Twist impulseAt(const Vector3d& impulse, const Vector3d& arm) {
  Twist twist;
  twist << impulse, arm.cross(impulse);
  return twist;
}

BodyContactSolver::BodyContactSolver(std::size_t most_bodies, std::size_t most_contacts) {
  const auto size = static_cast<Eigen::Index>(6 * most_bodies);
  now_.bodies.reserve(most_bodies);
  now_.contacts.reserve(most_contacts);
  held_.reserve(most_contacts);
  masses_ = inverse_ = Eigen::MatrixXd::Zero(size, size);
  factor_ = Eigen::LLT<Eigen::MatrixXd>(size);
  columns_ = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(3 * most_contacts));
  velocities_ = impulses_ = VectorXd::Zero(size);
}

void BodyContactSolver::begin(const RigidBodies& bodies, double h) {
  now_ = bodies;
  h_ = h;
  masses_.setZero();
  for (std::size_t b = 0; b < now_.bodies.size(); ++b) {
    const auto row = static_cast<Eigen::Index>(6 * b);
    masses_.block<3, 3>(row, row).diagonal().setConstant(now_.bodies[b].mass);
    masses_.block<3, 3>(row + 3, row + 3) = now_.bodies[b].inertia;
  }
  held_.resize(now_.contacts.size());
  for (Held& held : held_) {
    held.impulse.setZero();
    held.state = State::kOpen;
  }
  setSystem(masses_);
}

void BodyContactSolver::setSystem(const Eigen::MatrixXd& system) {
  factor_.compute(system);
  inverse_.setIdentity();
  factor_.solveInPlace(inverse_);
  for (std::size_t c = 0; c < held_.size(); ++c) {
    const BodyContact& contact = now_.contacts[c];
    auto columns = columns_.middleCols<3>(static_cast<Eigen::Index>(3 * c));
    columns.noalias() =
        inverse_.middleCols<6>(6 * contact.body).lazyProduct(impulsesAt(contact.arm));
    if (contact.other >= 0) {
      columns.noalias() -=
          inverse_.middleCols<6>(6 * contact.other).lazyProduct(impulsesAt(contact.other_arm));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const Twist of_body = columns.col(axis).segment<6>(6 * contact.body);
      held_[c].delassus.col(axis) = velocityAt(of_body, contact.arm);
      if (contact.other < 0) continue;
      const Twist of_other = columns.col(axis).segment<6>(6 * contact.other);
      held_[c].delassus.col(axis) -= velocityAt(of_other, contact.other_arm);
    }
    held_[c].inverse = held_[c].delassus.inverse();
  }
}

/// Without the velocity of what is no body.
Vector3d BodyContactSolver::slip(const BodyContact& contact, const VectorXd& velocities) const {
  Vector3d slip = velocityAt(velocities.segment<6>(6 * contact.body), contact.arm);
  if (contact.other >= 0) {
    slip -= velocityAt(velocities.segment<6>(6 * contact.other), contact.other_arm);
  }
  return slip;
}

void BodyContactSolver::addImpulse(const BodyContact& contact, const Vector3d& impulse,
                                   VectorXd& sum) const {
  sum.segment<6>(6 * contact.body) += impulseAt(impulse, contact.arm);
  if (contact.other >= 0) {
    sum.segment<6>(6 * contact.other) -= impulseAt(impulse, contact.other_arm);
  }
}

const VectorXd& BodyContactSolver::solve(const VectorXd& right) {
  velocities_.noalias() = inverse_ * right;
  iterate(true);
  return velocities_;
}

const VectorXd& BodyContactSolver::settle(const VectorXd& right) {
  velocities_.noalias() = inverse_ * right;
  iterate(false);
  return velocities_;
}

/// From the impulses of the last time, which what comes next is often near to.
void BodyContactSolver::iterate(bool keeps_gaps) {
  for (std::size_t c = 0; c < held_.size(); ++c) {
    if (!keeps_gaps) held_[c].impulse.setZero();
    velocities_.noalias() +=
        columns_.middleCols<3>(static_cast<Eigen::Index>(3 * c)) * held_[c].impulse;
  }
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double change = 0.0;
    for (std::size_t c = 0; c < held_.size(); ++c) {
      if (!keeps_gaps && held_[c].state == State::kOpen) continue;
      const State state = held_[c].state;
      change = std::max(change, relax(c, keeps_gaps ? now_.contacts[c].gap / h_ : 0.0));
      if (!keeps_gaps) held_[c].state = state;
    }
    if (!(change > kConverged * velocities_.cwiseAbs().maxCoeff() + kStill)) return;
  }
}

/// Brings one contact to its law while the others stay. @param bias m/s @return change, m/s
double BodyContactSolver::relax(std::size_t index, double bias) {
  const BodyContact& contact = now_.contacts[index];
  Held& held = held_[index];
  const Vector3d& n = contact.normal;
  const Vector3d motion = slip(contact, velocities_) - contact.velocity + bias * n;
  Vector3d impulse = held.impulse - held.inverse * motion;
  double load = n.dot(impulse);
  Vector3d friction = impulse - load * n;
  State state = State::kSticks;
  if (!(load > 0.0) || !(friction.norm() <= contact.friction * load)) {
    const double along = n.dot(held.delassus * n);
    const double across = held.delassus.trace() - along;
    const double closing = n.dot(motion);
    load = std::max(0.0, n.dot(held.impulse) - closing / along);
    friction = held.impulse - n.dot(held.impulse) * n - (motion - closing * n) / across;
    const double size = friction.norm(), limit = contact.friction * load;
    state = load > 0.0 ? (size > limit ? State::kSlips : State::kSticks) : State::kOpen;
    if (size > limit) friction *= limit / size;
    impulse = load * n + friction;
  }
  const Vector3d change = impulse - held.impulse;
  held.impulse = impulse;
  held.state = state;
  velocities_.noalias() += columns_.middleCols<3>(static_cast<Eigen::Index>(3 * index)) * change;
  return (held.delassus * change).norm();
}

const VectorXd& BodyContactSolver::respond(const VectorXd& change) {
  velocities_.noalias() = inverse_ * change;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0.0;
    for (std::size_t c = 0; c < held_.size(); ++c) {
      const Held& held = held_[c];
      if (held.state == State::kOpen) continue;
      const Vector3d& n = now_.contacts[c].normal;
      const Vector3d motion = slip(now_.contacts[c], velocities_);
      const Vector3d impulse = held.state == State::kSticks
                                   ? Vector3d(-held.inverse * motion)
                                   : Vector3d(-n.dot(motion) / n.dot(held.delassus * n) * n);
      velocities_.noalias() += columns_.middleCols<3>(static_cast<Eigen::Index>(3 * c)) * impulse;
      moved = std::max(moved, (held.delassus * impulse).norm());
    }
    if (!(moved > kConverged * velocities_.cwiseAbs().maxCoeff() + kStill)) break;
  }
  return velocities_;
}

const VectorXd& BodyContactSolver::impulses() {
  impulses_.setZero();
  for (std::size_t c = 0; c < held_.size(); ++c) {
    addImpulse(now_.contacts[c], held_[c].impulse, impulses_);
  }
  return impulses_;
}

}  // namespace haptex::cloth
