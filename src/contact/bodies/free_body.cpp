#include "haptex/contact/bodies/free_body.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"

namespace haptex::contact {

using cloth::Twist;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

const mesh::ObstacleBody& requireSound(const mesh::Obstacle& obstacle) {
  const std::string of = "obstacle " + base::quoted(obstacle.name) + ": ";
  if (!obstacle.body) base::refuse(of, "has no mass");
  const mesh::ObstacleBody& body = *obstacle.body;
  const bool known = std::holds_alternative<mesh::ObstacleSphere>(obstacle.shape) ||
                     std::holds_alternative<mesh::ObstacleBox>(obstacle.shape);
  if (!known) base::refuse(of, "a body with mass is allowed to be a sphere or a box");
  if (obstacle.motion.index() != 0) {
    base::refuse(of, "a body with mass goes as it is pushed; allowed is no motion beside it");
  }
  if (!std::isfinite(body.mass) || !(body.mass > 0.0)) {
    base::refuse(of, "mass is ", body.mass, " kg; it must be finite and > 0");
  }
  if (!std::isfinite(body.friction) || !(body.friction >= 0.0)) {
    base::refuse(of, "friction of the body is ", body.friction, "; it must be finite and >= 0");
  }
  if (!body.velocity.allFinite() || !body.angular_velocity.allFinite()) {
    base::refuse(of, "a velocity is not finite");
  }
  return body;
}

/// Moments of inertia about the axes of the obstacle's frame (kg m^2).
Vector3d principalMoments(const mesh::Obstacle& obstacle) {
  const double mass = obstacle.body->mass;
  if (const auto* sphere = std::get_if<mesh::ObstacleSphere>(&obstacle.shape)) {
    return Vector3d::Constant(0.4 * mass * sphere->radius * sphere->radius);
  }
  const Vector3d squared = std::get<mesh::ObstacleBox>(obstacle.shape).sides.array().square();
  return mass / 12.0 * (Vector3d::Constant(squared.sum()) - squared);
}

/// Half of w q, with w a vector: how a rotation q changes that turns by w (rad/s, world frame).
Quaterniond rateOf(const Vector3d& w, const Quaterniond& q) {
  Quaterniond rate = Quaterniond(0.0, w.x(), w.y(), w.z()) * q;
  rate.coeffs() *= 0.5;
  return rate;
}

}  // namespace

FreeBody::FreeBody(const mesh::Obstacle& obstacle)
    : mass_(requireSound(obstacle).mass),
      friction_(obstacle.body->friction),
      principal_(principalMoments(obstacle)),
      pose_(obstacle.pose),
      momentum_(mass_ * obstacle.body->velocity),
      angular_momentum_(inertia() * obstacle.body->angular_velocity) {}

Matrix3d FreeBody::inertia() const {
  return pose_.linear() * principal_.asDiagonal() * pose_.linear().transpose();
}

Twist FreeBody::velocity() const {
  Twist twist;
  const Vector3d turned = pose_.linear().transpose() * angular_momentum_;
  twist << momentum_ / mass_, pose_.linear() * turned.cwiseQuotient(principal_);
  return twist;
}

double FreeBody::kineticEnergy() const {
  const Vector3d turned = pose_.linear().transpose() * angular_momentum_;
  return 0.5 * momentum_.squaredNorm() / mass_ + 0.5 * turned.dot(turned.cwiseQuotient(principal_));
}

/// The rotation after h seconds in which the angular momentum stays, by Runge-Kutta steps of 1/20
/// rad at most, as long as kMostSteps of them suffice.
Quaterniond FreeBody::turned(const Vector3d& angular_momentum, double h) const {
  constexpr double kAngle = 0.05;
  constexpr int kMostSteps = 10000;
  const auto rate = [&](const Quaterniond& q) {
    const Matrix3d axes = q.normalized().toRotationMatrix();
    const Vector3d inside = axes.transpose() * angular_momentum;
    return rateOf(axes * inside.cwiseQuotient(principal_), q);
  };
  Quaterniond q(pose_.linear());
  const double angle = h * angular_momentum.norm() / principal_.minCoeff();
  if (!std::isfinite(angle)) return q;
  const int steps = std::clamp(static_cast<int>(std::min(angle / kAngle, 1e9)) + 1, 1, kMostSteps);
  const double part = h / steps;
  for (int i = 0; i < steps; ++i) {
    const auto after = [&](const Quaterniond& slope, double time) {
      Quaterniond moved = q;
      moved.coeffs() += time * slope.coeffs();
      return moved;
    };
    const Quaterniond first = rate(q), second = rate(after(first, 0.5 * part)),
                      third = rate(after(second, 0.5 * part)), fourth = rate(after(third, part));
    q.coeffs() += part / 6.0 *
                  (first.coeffs() + 2.0 * second.coeffs() + 2.0 * third.coeffs() + fourth.coeffs());
    q.normalize();
  }
  return q;
}

Eigen::Isometry3d FreeBody::poseAfter(const Twist& way, double h) const {
  Eigen::Isometry3d pose = pose_;
  pose.translation() += h * way.head<3>();
  pose.linear() = turned(inertia() * way.tail<3>(), h).toRotationMatrix();
  return pose;
}

void FreeBody::move(const Twist& way, double h, const Twist& end) {
  momentum_ = mass_ * end.head<3>();
  angular_momentum_ = inertia() * end.tail<3>();
  pose_ = poseAfter(way, h);
}

void FreeBody::fly(const Vector3d& gravity, double h) {
  pose_.linear() = turned(angular_momentum_, h).toRotationMatrix();
  pose_.translation() += h / mass_ * momentum_ + 0.5 * h * h * gravity;
  momentum_ += h * mass_ * gravity;
}

void FreeBody::push(const Vector3d& impulse, const Vector3d& arm) {
  momentum_ += impulse;
  angular_momentum_ += arm.cross(impulse);
}

void FreeBody::shift(const Vector3d& way, const Vector3d& angular_momentum) {
  pose_.translation() += way;
  angular_momentum_ += angular_momentum;
}

double FreeBody::mobility(const Vector3d& direction, const Vector3d& arm) const {
  const Vector3d moment = pose_.linear().transpose() * arm.cross(direction);
  return 1.0 / mass_ + moment.dot(moment.cwiseQuotient(principal_));
}

}  // namespace haptex::contact
