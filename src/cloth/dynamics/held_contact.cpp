#include "haptex/cloth/dynamics/held_contact.h"

#include <algorithm>

namespace haptex::cloth {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using State = ContactReaction::State;

RelativeMotion relativeMotion(const HeldContact& contact, const Vector3d& velocity) {
  const Vector3d relative = velocity - contact.target;
  const double gap = contact.normal.dot(relative);
  return {gap, relative - gap * contact.normal};
}

Vector3d frictionAt(const HeldContact& contact, const Vector3d& slip, double load,
                    double smoothing) {
  return -contact.friction * load / std::max(slip.norm(), smoothing) * slip;
}

Matrix3d frictionResistance(const HeldContact& contact, double smoothing) {
  const double speed = contact.slip.norm();
  Matrix3d across = Matrix3d::Identity() - contact.normal * contact.normal.transpose();
  if (speed > smoothing) across -= contact.slip * contact.slip.transpose() / (speed * speed);
  return contact.friction * contact.load / std::max(speed, smoothing) * across;
}

void close(const RelativeMotion& motion, HeldContact& contact) {
  const bool sticks =
      contact.friction > 0.0 && motion.slip.norm() <= contact.friction * -motion.gap;
  contact.state = sticks ? State::kSticks : State::kSlips;
  contact.load = 0.0;
  contact.slip = motion.slip;
}

void judge(const Vector3d& velocity, double a, double smoothing, HeldContact& contact) {
  constexpr double kRounding = 1e-9;  // of the limit of friction
  constexpr double kBeyond = 1.001;   // smoothing: what begins to slip has all its friction
  if (contact.state == State::kOpen) {
    const RelativeMotion motion = relativeMotion(contact, velocity);
    if (a * motion.gap < -kContactPenetration) close(motion, contact);
    return;
  }
  contact.load = contact.normal.dot(contact.force);
  if (!(contact.load >= 0.0)) {
    static_cast<ContactMemory&>(contact) = ContactMemory{};
    return;
  }
  if (contact.friction == 0.0 || contact.state == State::kSlips) return;
  const Vector3d tangential = contact.force - contact.load * contact.normal;
  const double size = tangential.norm();
  if (size <= (1.0 + kRounding) * contact.friction * contact.load) return;
  contact.state = State::kSlips;
  contact.slip = -kBeyond * smoothing / size * tangential;
}

void bringIntoCone(HeldContact& contact) {
  const double load = contact.normal.dot(contact.force);
  if (!(load > 0.0)) {
    contact.force.setZero();
    return;
  }
  Vector3d tangential = contact.force - load * contact.normal;
  const double size = tangential.norm(), limit = contact.friction * load;
  if (size > limit) tangential *= limit / size;
  contact.force = load * contact.normal + tangential;
  contact.load = load;
}

}  // namespace haptex::cloth
