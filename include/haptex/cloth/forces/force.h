// What every force on a cloth can do, for those who step the cloth in time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "haptex/cloth/forces/jacobian_rows.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/linear/thread_pool.h"

namespace haptex::cloth {

using Positions = std::vector<Eigen::Vector3d>;   ///< m, one per particle
using Velocities = std::vector<Eigen::Vector3d>;  ///< m/s, one per particle

/// Strains of earlier instants, and the rate of strain that follows from them, which is zero under
/// every rigid motion, however large:
///   e'(x) = (e(x) - e*) / a,  e* = sum of weights[k] e(positions[k]),  the weights' sum being 1.
struct StrainPast {
  double a = 0.0;                               ///< s, > 0
  int count = 0;                                ///< of what follows, from 1
  std::array<const Positions*, 3> positions{};  ///< m
  std::array<double, 3> weights{};

  /// (e(x) - e(before)) / duration
  static StrainPast since(const Positions& before, double duration) {
    StrainPast past{duration};
    past.add(before, 1.0);
    return past;
  }
  void add(const Positions& at, double weight) {
    positions[count] = &at;
    weights[count++] = weight;
  }
  /// e*. @param strain_at of positions: a number or a vector
  template <typename Strain>
  auto strain(const Strain& strain_at) const {
    auto sum = strain_at(*positions[0]);
    sum *= weights[0];
    for (int k = 1; k < count; ++k) sum += weights[k] * strain_at(*positions[k]);
    return sum;
  }
};

/// What a force depends on. Nothing of it is checked.
struct ForceState {
  const Positions& positions;
  const Velocities& velocities;
  double time = 0.0;                 ///< s, simulated
  const double* memory = nullptr;    ///< Force::memorySize() numbers of this force
  const StrainPast* past = nullptr;  ///< what rates of strain are taken from by addForces(); null:
                                     ///< from the velocities
  linear::ThreadPool* pool = nullptr;  ///< shares the work; null: none does. Changes no result
};

/// Times (s) of an implicit stage, x = x* + a v, that is linearised about a state (Stage).
struct StageTimes {
  double a;      ///< > 0; the time step in backward Euler
  double ahead;  ///< in which the state's velocities bring it to the stage: a in backward Euler, 0
                 ///< if it is there already
};

/// What the Newton iterations of a stage hold fixed is taken from.
struct NewtonStart {
  const Positions& base;  ///< where the stage starts from, m
  const ForceState& at;   ///< near its end; strain rates are those since its past or, without one,
                          ///< of its velocities
  double a;               ///< s, StageTimes; also that of the past
  bool passive;           ///< nothing is held that would do work if it were held for long
};

/// The Hessian of a Newton iteration: exact, for fast convergence near a minimum, or projected to
/// be positive semidefinite, for a descent from everywhere.
enum class Hessian { kExact, kProjected };

/// A force on the particles of a mesh. The functions allocate nothing but where they say so.
class Force {
 public:
  virtual ~Force() = default;

  /// Pairs of particles, smaller index first, that the matrix couples and no triangle has.
  /// Allocates.
  virtual std::vector<std::array<int, 2>> pairs() const { return {}; }
  /// Looks up where the blocks are that the force adds to. Before the functions with a matrix, and
  /// again for a matrix with another pattern. Allocates.
  /// @throws std::out_of_range if the pattern lacks a block
  virtual void bind(const linear::SymmetricBlockMatrix& matrix);

  /// How many numbers the force remembers from step to step.
  virtual std::size_t memorySize() const { return 0; }
  /// Writes the memory of a cloth that has rested here for ever.
  virtual void forget(const Positions& positions, double* memory) const;
  /// The particles that each number of the memory is about, in the order of the element's corners.
  /// Allocates.
  virtual std::vector<std::vector<int>> memoryOwners() const { return {}; }
  /// Lets the memory follow the positions, at the end of every step.
  virtual void remember(const Positions& positions, double* memory) const;

  /// Adds the forces (N) on the particles.
  virtual void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const = 0;
  /// What the force holds (J): where it is conservative, the forces are the negative gradient.
  virtual double energy(const ForceState& state) const = 0;
  /// Adds the exact Jacobian, neither projected nor symmetric, of the rows that are asked for.
  /// Allocates.
  virtual void addJacobian(const ForceState& state, JacobianRows& rows) const = 0;

  /// Whether the force depends on what moves by itself, so that it can do work on a cloth at rest.
  virtual bool isDriven() const { return false; }
  /// Whether it changes with time where nothing moves.
  virtual bool changesWithTime() const { return false; }
  /// Power (W) that what drives the force feeds in: its velocity times the force.
  virtual double drivingPower(const ForceState& state) const;

  /// Adds what the force contributes to a linearised stage (Stage),
  ///   matrix += -a D - a^2 K,  rhs += a (F + ahead K v),
  /// with K and D projected so that what is added is positive semidefinite.
  virtual void assembleLinearised(const ForceState& state, const StageTimes& times,
                                  linear::SymmetricBlockMatrix& matrix,
                                  linear::BlockVector& rhs) const = 0;

  /// How many vectors Newton iterations of a stage hold fixed.
  virtual std::size_t heldSize() const { return 0; }
  /// Writes them. @param held heldSize() vectors, whose units are the force's own affair
  virtual void hold(const NewtonStart& start, Eigen::Vector3d* held) const;

  // Where nothing is held and the linearised force is the exact one, what follows need not be
  // written anew.

  /// Adds what the force contributes to a Newton iteration at the end of a stage:
  ///   matrix += a^2 times the Hessian of its incremental potential, rhs -= a times its gradient.
  virtual void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                              Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const;
  /// The incremental potential of assembleNewton() (J), up to a constant.
  virtual double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                                      double a) const;
};

}  // namespace haptex::cloth
