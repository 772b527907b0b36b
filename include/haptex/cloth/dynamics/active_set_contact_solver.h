// Contacts of particles in a stage of an implicit step: which hold, and the friction of each.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/friction_loads.h"
#include "haptex/cloth/dynamics/particle_contact.h"
#include "haptex/cloth/dynamics/stage.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// Solves linear systems of a stage under the conditions of Signorini and Coulomb,
///   gap >= 0, N >= 0, gap N = 0;  |T| <= mu N, and T opposite to the slip where there is any,
/// by the active-set form of Newton's method for the augmented Lagrangian of Alart and Curnier
/// (Comput. Methods Appl. Mech. Eng. 92, 1991). Each round solves the system with those contacts
/// that hold as exact linear constraints: what sticks has its velocity prescribed, what slips the
/// component along the normal, and friction mu N along its direction with the N of the same solve
/// (FrictionLoads) and the resistance mu N / |s| against slips s across it. Then what would pull
/// opens, what is penetrated closes, friction beyond mu N slips, and what friction would push
/// backwards sticks. What closes slips if it comes flatter than the cone, and sticks otherwise.
///
/// Whatever has been found when the rounds are spent, the force that acts lies in the cone: last
/// rounds let all contacts that push slip, with friction of the ratio T / N that they had, mu at
/// most. What had not converged shows as slip, not as force.
///
/// One contact per particle. Allocates nothing after construction.
class ActiveSetContactSolver {
 public:
  explicit ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern);

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

  /// Reads the normal forces off the solution of a round.
  void compareLoads(const linear::BlockVector& solution);
  /// Writes the right-hand side of a change of the loads that friction is taken from.
  /// @returns false if none is needed
  bool prepareLoads(linear::BlockVector& rhs) const;
  /// @param change that prepareLoads() led to, overwritten @param solution improved
  void addLoads(linear::BlockVector& change, linear::BlockVector& solution);

  /// Judges the solution of a round.
  /// @returns whether another round is needed
  bool update(linear::BlockVector& solution);

  /// What friction and bodies resist (J), with the normal forces of the last system, beyond the
  /// incremental potential without contacts.
  double potential(const Velocities& velocities) const;
  /// By how much the incremental potential falls along the solution of the last system (J), to
  /// the first order in its parts that are smooth.
  double descent(const linear::BlockVector& solution) const;
  /// The change has gone only this share of the way: forces are those in between.
  void shorten(double share);
  /// |b + a f| of a system for the change from velocities at which the forces f act.
  double residualNorm(const linear::BlockVector& rhs) const;

  /// Whether any particle would enter a body with these velocities.
  bool enter(const Velocities& velocities) const;

  /// What the last stage did: the velocities of particles whose contact holds become the body's,
  /// along the normal or altogether. Impacts are inelastic.
  void settle(Velocities& velocities) const;
  /// Whether any contact held in the last stage.
  bool holding() const;
  /// One per contact of the cloth.
  const std::vector<ContactReaction>& reactions() const { return reactions_; }

 private:
  using State = ContactReaction::State;
  enum class Phase {
    kSearch,   // for what holds
    kRatios,   // all that push slip with the ratios T / N that were found
    kForces,   // the forces themselves act, and constrain nothing
    kFinished
  };
  /// What the next stage starts from, of a contact that is there again.
  struct Memory {
    State state = State::kOpen;
    double load = 0.0;                               // N, normal
    Eigen::Vector3d slip = Eigen::Vector3d::Zero();  // m/s, that friction is linearised at
    long stage = -1;                                 // in which it was
  };
  struct Entry : Memory {
    int contact;             // of the cloth
    int particle;            // of that contact
    Eigen::Vector3d normal;  // of that contact
    Eigen::Vector3d body;    // m/s, its velocity
    Eigen::Vector3d target;  // m/s, of a particle that goes with the body and closes the gap
    double friction;
    double mass;               // kg
    bool fresh = false;        // was open in the round before
    Eigen::Vector3d force;     // N, of the last round
    Eigen::Vector3d ratio;     // friction over normal force of what slips
    Eigen::Vector3d before;    // N, of the system before
    Eigen::Vector3d change;    // m/s, of the slip, in the last round
  };

  Entry entryOf(const Cloth& cloth, const Stage& stage, int contact) const;
  Eigen::Vector3d relativeTo(const Entry& entry, const Eigen::Vector3d& velocity) const;
  void close(double gap, const Eigen::Vector3d& slip, Entry& entry) const;
  void judge(const Eigen::Vector3d& velocity, Entry& entry) const;
  Eigen::Vector3d frictionAt(const Entry& entry, const Eigen::Vector3d& slip, double load) const;
  Eigen::Matrix3d resistance(const Entry& entry) const;
  double meanSlip() const;
  double searchLine(const linear::BlockVector& solution);
  bool search(linear::BlockVector& solution);
  bool holdRatios(const linear::BlockVector& solution);
  void takeRatios();
  void clip();
  void finish();
  void constrain(const Entry& entry, linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
                 std::vector<char>& fixed, linear::BlockVector& prescribed);

  double a_ = 0.0;   // s, of the stage
  long stages_ = 0;  // so far
  Phase phase_ = Phase::kSearch;
  int rounds_ = 0;           // of this phase
  double smoothing_ = 0.0;   // m/s, of slips up to which friction grows with them
  bool last_ = false;        // round of the search
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
  Eigen::VectorXd loads_;    // N, that friction is taken from, by entry
  Eigen::VectorXd results_;  // N
  FrictionLoads friction_;
  std::vector<Memory> memory_;  // per particle
  std::vector<ContactReaction> reactions_;
};

}  // namespace haptex::cloth
