// The motion of a rigid body: where it is, and its momentum.
#pragma once

#include <Eigen/Geometry>

#include "haptex/cloth/dynamics/rigid_bodies.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::contact {

/// A sphere or a box of one density. What it keeps is momentum and angular momentum about its
/// centre of mass, so that neither changes but by impulses. World frame.
class FreeBody {
 public:
  /// As at the start.
  /// @throws std::invalid_argument naming the obstacle unless it is a sphere or a box without its
  ///   own motion, its mass is finite and > 0, its velocities are finite and its friction is finite
  ///   and >= 0
  explicit FreeBody(const mesh::Obstacle& obstacle);

  double mass() const { return mass_; }          ///< kg
  double friction() const { return friction_; }  ///< on other obstacles
  const Eigen::Isometry3d& pose() const { return pose_; }
  Eigen::Matrix3d inertia() const;  ///< kg m^2, about the centre, as it is turned now
  cloth::Twist velocity() const;    ///< of the centre, and angular
  const Eigen::Vector3d& momentum() const { return momentum_; }  ///< N s
  /// N m s, about the centre.
  const Eigen::Vector3d& angularMomentum() const { return angular_momentum_; }
  double kineticEnergy() const;  ///< J

  /// Moves for h seconds, beginning with this velocity, and turning as a body does that nothing
  /// turns; then it has that of the end.
  void move(const cloth::Twist& way, double h, const cloth::Twist& end);
  /// Moves for h seconds under gravity (m/s^2) alone: exactly, but for the turning of a box, which
  /// is right to the fourth order.
  void fly(const Eigen::Vector3d& gravity, double h);
  /// @param arm m, from the centre
  void push(const Eigen::Vector3d& impulse, const Eigen::Vector3d& arm);
  /// Moves the centre (m), and adds to the angular momentum (N m s).
  void shift(const Eigen::Vector3d& way, const Eigen::Vector3d& angular_momentum);
  /// 1/kg: what a unit impulse along a unit direction changes of the velocity there along it.
  double mobility(const Eigen::Vector3d& direction, const Eigen::Vector3d& arm) const;
  /// Where it would be after h seconds of this velocity.
  Eigen::Isometry3d poseAfter(const cloth::Twist& way, double h) const;

 private:
  Eigen::Quaterniond turned(const Eigen::Vector3d& angular_momentum, double h) const;

  double mass_;
  double friction_;
  Eigen::Vector3d principal_;  // kg m^2, about the axes of its frame
  Eigen::Isometry3d pose_;
  Eigen::Vector3d momentum_, angular_momentum_;
};

}  // namespace haptex::contact
