#include "haptex/cloth/dynamics/body_coupling.h"

namespace haptex::cloth {

using Eigen::Vector3d;
using Eigen::VectorXd;
using State = ContactReaction::State;

namespace {

constexpr int kFreedoms = 6;  // of a body

bool holds(const HeldContact& contact) {
  return contact.rigid >= 0 && contact.state != State::kOpen;
}

/// By how much the velocity (m/s) at a contact differs between two velocities of all bodies.
Vector3d changeAt(const HeldContact& contact, const VectorXd& from, const VectorXd& to) {
  const Eigen::Index row = kFreedoms * contact.rigid;
  const Twist change = to.segment<kFreedoms>(row) - from.segment<kFreedoms>(row);
  return velocityAt(change, contact.arm);
}

}  // namespace

BodyCoupling::BodyCoupling(std::size_t bodies, std::size_t contacts, int particles)
    : count_(bodies), solver_(bodies, contacts) {
  const auto size = static_cast<Eigen::Index>(kFreedoms * bodies);
  free_ = predicted_ = velocities_ = before_ = accepted_ = full_ = VectorXd::Zero(size);
  pushed_ = end_ = right_ = change_ = way_ = beyond_ = momentum_ = VectorXd::Zero(size);
  system_ = Eigen::MatrixXd::Zero(size, size);
  modes_.reserve(size);
  responses_.assign(size, linear::BlockVector::Zero(3, particles));
  motions_.resize(bodies);
}

void BodyCoupling::begin(const RigidBodies& bodies, double h) {
  for (std::size_t b = 0; b < count_; ++b) {
    const auto row = static_cast<Eigen::Index>(kFreedoms * b);
    free_.segment<kFreedoms>(row) = bodies.bodies[b].free;
    predicted_.segment<kFreedoms>(row) = bodies.bodies[b].predicted;
  }
  solver_.begin(bodies, h);
  right_.noalias() = solver_.masses() * free_;
  velocities_ = end_ = solver_.solve(right_);
  pushed_ = solver_.impulses();
}

void BodyCoupling::place(std::vector<HeldContact>& contacts) const {
  for (HeldContact& contact : contacts) {
    if (contact.rigid < 0) continue;
    const Vector3d beyond = changeAt(contact, predicted_, velocities_);
    contact.target = contact.predicted_target + beyond;
    contact.body = contact.predicted_body + beyond;
  }
}

void BodyCoupling::beginSystem() { before_ = accepted_ = full_ = velocities_; }

void BodyCoupling::beginRound(const std::vector<HeldContact>& contacts) {
  endRounds();
  for (int body = 0; body < static_cast<int>(count_); ++body) {
    for (const HeldContact& contact : contacts) {
      if (!holds(contact) || contact.rigid != body) continue;
      for (int freedom = 0; freedom < kFreedoms; ++freedom) {
        modes_.push_back(kFreedoms * body + freedom);
      }
      break;
    }
  }
}

void BodyCoupling::endRounds() {
  modes_.clear();
  system_ = solver_.masses();
}

Vector3d BodyCoupling::motion(int mode, const HeldContact& contact) const {
  if (contact.rigid != modes_[mode] / kFreedoms) return Vector3d::Zero();
  return velocityAt(Twist::Unit(modes_[mode] % kFreedoms), contact.arm);
}

void BodyCoupling::setResponse(int mode, const linear::BlockVector& response,
                               const linear::BlockVector& product,
                               const std::vector<HeldContact>& contacts) {
  responses_[modes_[mode]] = response;
  change_.setZero();
  sumImpulses(product, contacts);
  system_.col(modes_[mode]) += change_;
}

/// Adds to change_ what impulses (N s) at the contacts that hold are together.
void BodyCoupling::sumImpulses(const linear::BlockVector& impulses,
                               const std::vector<HeldContact>& contacts) {
  for (const HeldContact& contact : contacts) {
    if (!holds(contact)) continue;
    change_.segment<kFreedoms>(kFreedoms * contact.rigid) +=
        impulseAt(impulses.col(contact.particle), contact.arm);
  }
}

void BodyCoupling::solve(const linear::BlockVector& residual,
                         const std::vector<HeldContact>& contacts, linear::BlockVector& solution) {
  change_.setZero();
  sumImpulses(residual, contacts);
  right_.noalias() = solver_.masses() * free_;
  right_ -= change_;
  right_.noalias() += system_ * velocities_;
  right_.noalias() -= solver_.masses() * velocities_;
  solver_.setSystem(system_);
  change_ = solver_.solve(right_) - velocities_;
  for (const int mode : modes_) solution += change_[mode] * responses_[mode];
  velocities_ += change_;
}

void BodyCoupling::respond(const linear::BlockVector& product,
                           const std::vector<HeldContact>& contacts, linear::BlockVector& change) {
  change_.setZero();
  sumImpulses(product, contacts);
  right_ = -change_;
  const VectorXd& response = solver_.respond(right_);
  for (const int mode : modes_) change += response[mode] * responses_[mode];
}

void BodyCoupling::takeForces(const std::vector<HeldContact>& contacts, double a) {
  right_.noalias() = solver_.masses() * free_;
  for (const HeldContact& contact : contacts) {
    if (contact.rigid < 0) continue;
    right_.segment<kFreedoms>(kFreedoms * contact.rigid) -=
        impulseAt(a * contact.force, contact.arm);
  }
  solver_.setSystem(solver_.masses());
  velocities_ = full_ = end_ = solver_.solve(right_);
  pushed_ = solver_.impulses();
}

/// a M b
double BodyCoupling::kinetic(const VectorXd& first, const VectorXd& second) const {
  momentum_.noalias() = solver_.masses() * second;
  return first.dot(momentum_);
}

double BodyCoupling::curvature() const {
  way_ = full_ - accepted_;
  return kinetic(way_, way_);
}

double BodyCoupling::slope() const {
  way_ = full_ - accepted_;
  beyond_ = full_ - free_;
  return kinetic(way_, beyond_) - way_.dot(pushed_);
}

double BodyCoupling::bodyPart(const HeldContact& contact) const {
  return contact.rigid < 0 ? 0.0 : contact.normal.dot(changeAt(contact, accepted_, full_));
}

void BodyCoupling::accept(double share) {
  accepted_ += share * (full_ - accepted_);
  velocities_ = accepted_;
}

double BodyCoupling::potential() const {
  beyond_ = velocities_ - free_;
  return 0.5 * kinetic(beyond_, beyond_) - pushed_.dot(velocities_);
}

double BodyCoupling::descent() const {
  way_ = full_ - before_;
  beyond_ = before_ - free_;
  return way_.dot(pushed_) - kinetic(way_, beyond_);
}

Vector3d BodyCoupling::way(const HeldContact& contact) const {
  return changeAt(contact, before_, full_);
}

void BodyCoupling::settle(const std::vector<HeldContact>& contacts,
                          const std::vector<ContactReaction>& reactions, Velocities& velocities) {
  system_ = solver_.masses();
  right_.noalias() = solver_.masses() * end_;
  for (const HeldContact& contact : contacts) {
    const State state = reactions[contact.contact].state;
    if (contact.rigid < 0 || state == State::kOpen) continue;
    Eigen::Matrix3d held = Eigen::Matrix3d::Identity();
    if (state == State::kSlips) held = contact.normal * contact.normal.transpose();
    const auto row = static_cast<Eigen::Index>(kFreedoms * contact.rigid);
    for (int freedom = 0; freedom < kFreedoms; ++freedom) {
      const Vector3d moved = held * velocityAt(Twist::Unit(freedom), contact.arm);
      system_.col(row + freedom).segment<kFreedoms>(row) +=
          impulseAt(contact.mass * moved, contact.arm);
    }
    right_.segment<kFreedoms>(row) +=
        impulseAt(contact.mass * held * velocities[contact.particle], contact.arm);
  }
  solver_.setSystem(system_);
  end_ = solver_.settle(right_);
  for (const HeldContact& contact : contacts) {
    const State state = reactions[contact.contact].state;
    if (contact.rigid < 0 || state == State::kOpen) continue;
    Vector3d& velocity = velocities[contact.particle];
    const Vector3d way =
        velocityAt(end_.segment<kFreedoms>(kFreedoms * contact.rigid), contact.arm) - velocity;
    velocity += state == State::kSlips ? Vector3d(contact.normal * contact.normal.dot(way)) : way;
  }
}

const std::vector<BodyMotion>& BodyCoupling::motions() {
  for (std::size_t b = 0; b < count_; ++b) {
    const auto row = static_cast<Eigen::Index>(kFreedoms * b);
    motions_[b] = {velocities_.segment<kFreedoms>(row), end_.segment<kFreedoms>(row)};
  }
  return motions_;
}

}  // namespace haptex::cloth
