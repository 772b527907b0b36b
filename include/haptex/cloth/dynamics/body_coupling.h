// Rigid bodies among the unknowns of a stage, beside the particles that touch them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/held_contact.h"
#include "haptex/cloth/dynamics/rigid_bodies.h"
#include "haptex/cloth/forces/force.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// How a body has gone through a step.
struct BodyMotion {
  Twist way;  ///< m/s and rad/s: this, for the length of the step, has moved it
  Twist end;  ///< m/s and rad/s, at the end, after inelastic impacts
};

/// With the contacts that hold, the velocities of the particles that touch a body follow its own,
///   v_i = ... + J_i u,  J_i u = velocityAt(u, arm_i),
/// and what the contacts exert on them acts on it in turn. Of the linear system A x = b of a round
/// the bodies leave the Schur complement
///   (M + sum J_i^T (A X)_i) u = M u_free - sum J_i^T (A x - b)_i + impulses of their own contacts,
/// with one column of X per degree of freedom, how the cloth responds to a contact that moves so:
/// six solves more of the same matrix for each body that is touched. Bodies and cloth then move in
/// one implicit step, stable whatever the ratio of their masses, and what one loses the other gets.
///
/// Allocates nothing after construction.
class BodyCoupling {
 public:
  /// @param contacts most of BodyContacts
  BodyCoupling(std::size_t bodies, std::size_t contacts, int particles);
  bool empty() const { return count_ == 0; }

  /// Takes the bodies over, as they go without cloth. @param h s, of the step
  void begin(const RigidBodies& bodies, double h);
  /// Writes the targets of the contacts as the bodies go now.
  void place(std::vector<HeldContact>& contacts) const;

  /// What solves change begins with the velocities of now.
  void beginSystem();
  /// Finds the degrees of freedom that contacts of the round move with.
  void beginRound(const std::vector<HeldContact>& contacts);
  /// No contact constrains the rounds to come.
  void endRounds();
  int modes() const { return static_cast<int>(modes_.size()); }
  /// How a contact moves with a degree of freedom; zero if it is another body's.
  Eigen::Vector3d motion(int mode, const HeldContact& contact) const;
  /// @param response X's column @param product A times that
  void setResponse(int mode, const linear::BlockVector& response,
                   const linear::BlockVector& product, const std::vector<HeldContact>& contacts);
  /// Moves bodies and cloth to where both are in balance.
  /// @param residual A x - b of the solution x so far, which is improved
  void solve(const linear::BlockVector& residual, const std::vector<HeldContact>& contacts,
             linear::BlockVector& solution);
  /// Lets the bodies respond to a change of the solution. @param product A times that
  void respond(const linear::BlockVector& product, const std::vector<HeldContact>& contacts,
               linear::BlockVector& change);
  /// Gives the bodies the velocities that the contacts' forces lead to: momentum is exact, however
  /// well the system was solved. @param a s, of the stage
  void takeForces(const std::vector<HeldContact>& contacts, double a);

  // On the way from what was accepted in the rounds before, or what the system began with.
  double curvature() const;  ///< of the kinetic energy, J
  double slope() const;      ///< of the incremental potential at the end of the way, J
  /// How the velocity of its body changes at a contact, along the normal (m/s); 0 without a body.
  double bodyPart(const HeldContact& contact) const;
  void accept(double share);
  /// Of the way since beginSystem().
  void go(double share) { velocities_ = end_ = before_ + share * (full_ - before_); }
  double potential() const;  ///< incremental, J
  double descent() const;    ///< of it along the way since beginSystem(), J
  /// Of a contact, since beginSystem() (m/s).
  Eigen::Vector3d way(const HeldContact& contact) const;

  /// The velocities after the step: an inelastic impact of the bodies with the particles that
  /// contacts hold. Momentum and angular momentum about the contacts' arms stay.
  void settle(const std::vector<HeldContact>& contacts,
              const std::vector<ContactReaction>& reactions, Velocities& velocities);
  /// By the last begin() and what followed.
  const std::vector<BodyMotion>& motions();

 private:
  double kinetic(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const;
  void sumImpulses(const linear::BlockVector& impulses, const std::vector<HeldContact>& contacts);

  std::size_t count_;
  BodyContactSolver solver_;
  Eigen::VectorXd free_, predicted_;
  Eigen::VectorXd velocities_;  // now
  Eigen::VectorXd before_;      // in the beginning of the system
  Eigen::VectorXd accepted_, full_;
  Eigen::VectorXd pushed_;  // impulses of the bodies' own contacts
  Eigen::VectorXd end_;     // of settle()
  Eigen::VectorXd right_, change_;
  mutable Eigen::VectorXd way_, beyond_, momentum_;
  Eigen::MatrixXd system_;  // S, by columns
  std::vector<int> modes_;  // numbers of velocities
  std::vector<linear::BlockVector> responses_;
  std::vector<BodyMotion> motions_;
};

}  // namespace haptex::cloth
