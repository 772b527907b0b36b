// Contacts of particles in a stage of an implicit step: which hold, and the friction of each.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/body_coupling.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/friction_loads.h"
#include "haptex/cloth/dynamics/held_contact.h"
#include "haptex/cloth/dynamics/particle_contact.h"
#include "haptex/cloth/dynamics/stage.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// Solves linear systems of a stage under the conditions of Signorini and Coulomb,
///   gap >= 0, N >= 0, gap N = 0;  |T| <= mu N, and T opposite to the slip where there is any.
/// Each round solves the system with those contacts that hold as exact linear constraints: what
/// sticks has its velocity prescribed, what slips the component along the normal. Friction of what
/// slips is that of the normal forces of the same solve (FrictionLoads), linearised by slips that
/// are slower than a threshold, at first a tenth of the mean slip, as if it grew with them. With
/// these loads it has a convex potential, and so has the stage: a round goes on from the one before
/// as far as that potential falls (exact line search), which Newton's method needs to converge.
/// Then what would pull opens, what is entered closes (as the map of Alart and Curnier says,
/// Comput. Methods Appl. Mech. Eng. 92, 1991), and what sticks with more than mu N slips. Smoothed
/// friction that has converged becomes Coulomb's: what creeps below the threshold sticks from then
/// on, or slips again if that takes more than mu N, with a lower threshold. If that does not
/// converge in the rounds that are left, the smoothed friction acts.
///
/// Whatever has been found when the rounds are spent, the force that acts lies in the cone: last
/// rounds let all contacts that push slip, with friction of the ratio T / N that they had, mu at
/// most, until none of them pulls; and if one still does, the forces themselves act, without those
/// that pull. What had not converged shows as slip, not as force.
///
/// Rigid bodies that contacts push (Cloth::bodies()) are unknowns, too: BodyCoupling.
///
/// One contact per particle. Allocates nothing after construction.
class ActiveSetContactSolver {
 public:
  explicit ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern,
                                  const RigidBodies& bodies = {});

  /// Takes over the contacts. Each starts from what its particle's did in the last stage.
  /// @param attached per particle; contacts of attached ones are left out
  void begin(const Cloth& cloth, const Stage& stage, const Velocities& guess,
             const std::vector<char>& attached);
  bool empty() const { return entries_.empty(); }

  /// The system (A, b) for the change from some velocities, before anything is eliminated.
  void beginSystem(const Velocities& velocities, const linear::SymmetricBlockMatrix& matrix,
                   const linear::BlockVector& rhs);

  /// Writes the system of the next round: friction is added, `fixed` and `prescribed` are set where
  /// contacts stick. What they and confine() say is not eliminated yet.
  /// @returns whether any particle is fixed
  bool prepareRound(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
                    std::vector<char>& fixed, linear::BlockVector& prescribed);

  /// Eliminates the normal components of what slips, after the fixed particles.
  void confine(linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;
  /// Takes the normal components of what slips out of a guess, and puts their values in.
  void removeNormal(linear::BlockVector& solution) const;
  void putNormal(linear::BlockVector& solution) const;

  /// Degrees of freedom of the bodies that this round's contacts hold to, and the right-hand side
  /// whose solution is how the cloth responds to one.
  int modes() const { return bodies_.modes(); }
  void prepareMode(int mode, linear::BlockVector& rhs);
  /// @param response that prepareMode() led to, overwritten
  void setResponse(int mode, linear::BlockVector& response);
  /// Moves the bodies, and the solution with them, once all responses are known.
  void moveBodies(linear::BlockVector& solution);

  /// Reads the normal forces off the solution of a round.
  void compareLoads(const linear::BlockVector& solution);
  /// Writes the right-hand side of a change of the loads that friction is taken from.
  /// @returns false if none is needed
  bool prepareLoads(linear::BlockVector& rhs) const;
  /// @param change that prepareLoads() led to, overwritten @param solution improved
  void addLoads(linear::BlockVector& change, linear::BlockVector& solution);

  /// Judges the solution of a round.
  /// @returns whether another round is needed
  bool update(const linear::BlockVector& solution);

  /// What friction and bodies resist (J), with the normal forces of the last system, beyond the
  /// incremental potential without contacts.
  double potential(const Velocities& velocities) const;
  /// By how much the incremental potential falls along the solution of the last system (J), to
  /// the first order in its parts that are smooth.
  double descent(const linear::BlockVector& solution) const;
  /// Bodies go this share of the way that the last system has found.
  void moveBodies(double share);
  /// The change has gone only this share of the way: forces are those in between.
  void shorten(double share);
  /// |b + a f| of a system for the change from velocities at which the forces f act.
  double residualNorm(const linear::BlockVector& rhs) const;

  /// Whether any particle would enter a body with these velocities, farther than `depth` (m).
  bool enter(const Velocities& velocities, double depth) const;

  /// What the last stage did: the velocities of particles whose contact holds become the body's,
  /// along the normal or altogether. Impacts are inelastic.
  void settle(Velocities& velocities);
  /// How the cloth's bodies have gone, in their order.
  const std::vector<BodyMotion>& bodyMotions() { return bodies_.motions(); }
  /// Whether any contact held in the last stage.
  bool holding() const;
  /// One per contact of the cloth.
  const std::vector<ContactReaction>& reactions() const { return reactions_; }

 private:
  using State = ContactReaction::State;
  enum class Phase {
    kSearch,  // for what holds
    kRatios,  // all that push slip with the ratios T / N that were found
    kForces,  // the forces themselves act, and constrain nothing
    kFinished
  };
  using Entry = HeldContact;

  Entry entryOf(const Cloth& cloth, const Stage& stage, int contact) const;
  double potentialOf(const Entry& entry, const Eigen::Vector3d& velocity) const;
  double meanSlip() const;
  double smoothingOfSlips() const;
  void takeForces();
  double searchLine(const linear::BlockVector& solution);
  bool search(const linear::BlockVector& solution);
  bool isSpent(double share);
  bool goBack();
  bool holdRatios(const linear::BlockVector& solution);
  void takeRatios();
  void finish();
  void constrain(const Entry& entry, linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
                 std::vector<char>& fixed, linear::BlockVector& prescribed);

  double a_ = 0.0;   // s, of the stage
  long stages_ = 0;  // so far
  Phase phase_ = Phase::kSearch;
  int rounds_ = 0;               // of this phase
  double smoothing_ = 0.0;       // m/s, of slips up to which friction grows with them
  bool last_ = false;            // round of the search
  double kept_smoothing_ = 0.0;  // m/s, of kept_; 0: nothing has been kept
  int kept_round_ = 0;           // that found it
  int stalled_rounds_ = 0;       // in a row
  // m/s, that friction of the last system has kept; 0: it was Coulomb's.
  double left_smoothing_ = 0.0;
  linear::BlockVector guess_;  // m/s
  linear::SymmetricBlockMatrix free_matrix_;
  linear::BlockVector free_rhs_;
  linear::BlockVector residual_;
  linear::BlockVector accepted_;  // solution of the rounds so far
  linear::BlockVector product_;
  std::vector<char> attached_;
  std::vector<char> confined_;
  linear::BlockVector normals_;
  linear::BlockVector values_;
  std::vector<Entry> entries_;
  std::vector<Entry> kept_;  // that friction had converged with, smoothed
  Eigen::VectorXd loads_;    // N, that friction is taken from, by entry
  Eigen::VectorXd results_;  // N
  FrictionLoads friction_;
  BodyCoupling bodies_;
  linear::BlockVector mode_;           // m/s, how contacts move with a degree of freedom
  std::vector<ContactMemory> memory_;  // per particle
  std::vector<ContactReaction> reactions_;
};

}  // namespace haptex::cloth
