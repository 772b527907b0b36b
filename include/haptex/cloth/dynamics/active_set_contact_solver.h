// Contacts of particles in a stage of an implicit step: which hold, and the friction of each.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/particle_contact.h"
#include "haptex/cloth/dynamics/stage.h"
#include "haptex/linear/block_matrix.h"

namespace haptex::cloth {

/// Solves a stage's linear system under the conditions of Signorini and Coulomb,
///   gap >= 0, N >= 0, gap N = 0;  |T| <= mu N, and T opposite to the slip where there is any,
/// by an active-set strategy: each round solves the system with those contacts that hold as exact
/// linear constraints (a contact that sticks fixes its particle, one that slips the component of
/// its velocity along the normal), and the friction of those that slip as a force of mu N with the
/// N of the round before; then contacts that would pull open, those that are penetrated close,
/// friction beyond mu N slips, and what friction would push backwards sticks. The first round
/// starts from what the particles' contacts did last. Contacts that go on to switch between stick
/// and slip get instead the resistance mu N / |s| against slips s, taken from the round before:
/// that converges whichever they do, from above for a given N. After some rounds contacts only
/// close: one that pulls for the rest of the stage holds its particle back, one that opens again
/// and again would leave it in the body.
///
/// One contact per particle. Allocates nothing after construction.
class ActiveSetContactSolver {
 public:
  explicit ActiveSetContactSolver(const linear::SymmetricBlockMatrix& pattern);

  /// Takes over the contacts and the stage's linear system, (A, b) for the change from the guess's
  /// velocities, before anything is eliminated.
  /// @param attached per particle; contacts of attached ones are left out
  void begin(const Cloth& cloth, const Stage& stage, const Velocities& guess,
             const std::vector<char>& attached, const linear::SymmetricBlockMatrix& matrix,
             const linear::BlockVector& rhs);
  bool empty() const { return entries_.empty(); }

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

  /// Judges the solution of a round.
  /// @param last keep what holds, there is no other round
  /// @returns whether another round is needed
  bool update(const linear::BlockVector& solution, bool last);

  /// Judges the contacts by the residual of a Newton iteration, and goes on as prepareRound(): adds
  /// friction, and fixes what sticks. Values are what is left to the constraints.
  /// @returns whether a contact has changed or is not where it should be, so that the next step of
  ///   the iteration is no descent
  bool addNewton(const Velocities& velocities, linear::SymmetricBlockMatrix& matrix,
                 linear::BlockVector& rhs, std::vector<char>& fixed,
                 linear::BlockVector& prescribed);
  /// The potential that addNewton() is the gradient of (J).
  double frictionPotential(const Velocities& velocities) const;

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
  /// What the next stage starts from, of a contact that is there again.
  struct Memory {
    State state = State::kOpen;
    double load = 0.0;                                    // N, normal, that friction is taken from
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // unit, of the friction of what slips
    double speed = 0.0;                                   // m/s, of the slip
    bool creeps = false;  // slips, with a resistance in every direction: see above
    long stage = -1;      // in which it was
  };
  struct Entry : Memory {
    int contact;             // of the cloth
    int particle;            // of that contact
    Eigen::Vector3d normal;  // of that contact
    Eigen::Vector3d body;    // m/s, its velocity
    Eigen::Vector3d target;  // m/s, of a particle that goes with the body and closes the gap
    double friction;
    double mass;  // kg
  };

  double frictionChange(const Entry& entry, const Entry& before) const;
  Entry entryOf(const Cloth& cloth, const Stage& stage, int contact) const;
  void judge(const Eigen::Vector3d& velocity, const Eigen::Vector3d& force, Entry& entry) const;
  void keep(const Entry& entry, State state, const Eigen::Vector3d& force);
  double lateralResistance(const Entry& entry) const;
  Eigen::Vector3d lateralSlip(const Entry& entry, const Eigen::Vector3d& velocity) const;
  bool constrain(const Entry& entry, const Eigen::Vector3d& velocity,
                 linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs,
                 std::vector<char>& fixed, linear::BlockVector& prescribed);
  void addFriction(const Entry& entry, const Eigen::Vector3d& velocity,
                   linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const;

  double a_ = 0.0;             // s, of the stage
  long stages_ = 0;            // so far
  int rounds_ = 0;             // of this stage
  linear::BlockVector guess_;  // m/s
  linear::SymmetricBlockMatrix free_matrix_;
  linear::BlockVector free_rhs_;
  linear::BlockVector residual_;
  std::vector<char> attached_;
  std::vector<char> confined_;
  linear::BlockVector normals_;
  linear::BlockVector values_;
  std::vector<Entry> entries_;
  std::vector<Memory> memory_;  // per particle
  std::vector<ContactReaction> reactions_;
};

}  // namespace haptex::cloth
