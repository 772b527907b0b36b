// Rigid bodies with mass in a step: what pushes them, and how they touch each other and what rests.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace haptex::cloth {

/// A velocity (m/s) of a body's centre of mass, and its angular velocity (rad/s); or an impulse
/// (N s) and its moment about the centre (N m s). World frame.
using Twist = Eigen::Matrix<double, 6, 1>;

/// A body in one step. World frame.
struct RigidBody {
  double mass;              ///< kg, > 0
  Eigen::Matrix3d inertia;  ///< kg m^2, about the centre of mass, as at the beginning of the step
  Twist free;               ///< that it would have at the end if nothing touched it
  Twist predicted;          ///< that the places of the contacts on it are predicted with
};

/// A contact of a body with another, or with something that moves as it wants. At the end of a step
/// of h seconds by which both have gone, it keeps
///   gap + h normal . (v - other's v) >= 0,
/// with Coulomb friction.
struct BodyContact {
  int body;
  int other;                  ///< another body; -1: none, what moves by `velocity`
  Eigen::Vector3d normal;     ///< unit, away from the other
  Eigen::Vector3d arm;        ///< m, from the body's centre to the contact
  Eigen::Vector3d other_arm;  ///< m, from the other body's
  Eigen::Vector3d velocity;   ///< m/s, of what is no body, at the contact
  double gap;                 ///< m, at the beginning; < 0: it has entered
  double friction;            ///< Coulomb's coefficient, >= 0
};

struct RigidBodies {
  std::vector<RigidBody> bodies;
  std::vector<BodyContact> contacts;
};

/// Velocity (m/s) at an arm (m) from the centre.
inline Eigen::Vector3d velocityAt(const Twist& twist, const Eigen::Vector3d& arm) {
  return twist.head<3>() + Eigen::Vector3d(twist.tail<3>()).cross(arm);
}
/// What an impulse (N s) at an arm (m) does.
Twist impulseAt(const Eigen::Vector3d& impulse, const Eigen::Vector3d& arm);

/// Solves for the velocities u of all bodies, one twist below the other,
///   S u = r + impulses of the BodyContacts,
/// by projected Gauss-Seidel over the contacts (Moreau 1988, Jean 1999): none of them pulls or lets
/// anything in, and friction lies in Coulomb's cone, against the slip where there is any. Impacts
/// are inelastic. Allocates nothing after construction, for as many contacts as it is made for.
class BodyContactSolver {
 public:
  BodyContactSolver(std::size_t most_bodies, std::size_t most_contacts);

  /// For the solves that follow, with the masses alone as S.
  /// @param h s, of the step
  void begin(const RigidBodies& bodies, double h);
  /// Goes on with another S, symmetric and positive definite (kg, kg m, kg m^2).
  void setSystem(const Eigen::MatrixXd& system);
  const Eigen::MatrixXd& masses() const { return masses_; }

  /// @param right r, N s and N m s @return u
  const Eigen::VectorXd& solve(const Eigen::VectorXd& right);
  /// How u changes with r while the contacts that held in the last solve() go on to hold, and those
  /// that stuck go on to stick.
  const Eigen::VectorXd& respond(const Eigen::VectorXd& change);
  /// As solve(), but for the velocities after the step: contacts that held in the last solve() let
  /// nothing come nearer, whatever their gap, and others do nothing.
  const Eigen::VectorXd& settle(const Eigen::VectorXd& right);

  /// Of the contacts on the bodies in the last solve(), N s and N m s.
  const Eigen::VectorXd& impulses();

 private:
  enum class State { kOpen, kSlips, kSticks };
  struct Held {
    Eigen::Matrix3d delassus;  // m/s per N s, at the contact
    Eigen::Matrix3d inverse;   // of it
    Eigen::Vector3d impulse;   // N s
    State state;               // in the last solve()
  };

  Eigen::Vector3d slip(const BodyContact& contact, const Eigen::VectorXd& velocities) const;
  void addImpulse(const BodyContact& contact, const Eigen::Vector3d& impulse,
                  Eigen::VectorXd& sum) const;
  double relax(std::size_t index, double bias);
  void iterate(bool keeps_gaps);

  RigidBodies now_;
  double h_ = 0.0;
  Eigen::MatrixXd masses_, inverse_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd columns_;  // velocities by the impulses of the contacts, three columns by contact
  std::vector<Held> held_;
  Eigen::VectorXd velocities_, impulses_;
};

}  // namespace haptex::cloth
