// A sheet that the processes of MPI have in parts: the reference solver for what is too large for
// one machine.
#pragma once

#include <iosfwd>
#include <optional>

#include "haptex/large/petsc_system.h"
#include "haptex/large/strip.h"

namespace haptex::large {

/// What a step did.
struct LargeStep {
  int newton_iterations = 0;  ///< linear solves of both stages
  int linear_iterations = 0;
  double residual = 0.0;   ///< of the last stage: of all forces (N, norm), over the sheet's weight
  bool converged = false;  ///< in both stages
};

/// J
struct SheetEnergy {
  double kinetic = 0.0, potential = 0.0;
};

/// Steps by TR-BDF2 with Newton iterations to the end, as cloth::Integrator does with those
/// settings, but without its energy balance: each process has successive rows of particles and
/// knows those around them, assembles its rows of each system, and PETSc solves it.
///
/// The incremental potential, by which line searches judge, is the sum of those of all strips less
/// those of the rows that neighbours both know.
///
/// All functions are called by all processes, in the same order.
class LargeSheet {
 public:
  /// At rest.
  /// @throws std::invalid_argument if there are fewer rows of particles than processes;
  ///   std::runtime_error, as all functions do, if PETSc fails
  explicit LargeSheet(const Sheet& sheet);

  /// @param time_step s, finite and > 0
  LargeStep step(double time_step);

  double time() const { return strip_.state().time; }  ///< s
  /// Of the rows that this process knows.
  const cloth::ClothState& state() const { return strip_.state(); }
  SheetEnergy energy() const;
  /// m, world z, of all particles.
  double lowest() const;
  /// All of the sheet as an OBJ file with rest coordinates, by the first process, which never has
  /// more of it than one part. @param out of the first process
  void writeObj(std::ostream& out) const;

 private:
  void solveStage(LargeStep& step);
  bool iterateNewton(double potential, LargeStep& step);
  enum class Descent { kFound, kBelowRounding, kNone };
  Descent searchLine(double& potential);
  double potentialOf(const cloth::ClothState& at);
  void copyShared(const cloth::ClothState& from, cloth::ClothState& to) const;
  bool solve(LargeStep& step);

  Sheet sheet_;
  int part_, parts_;
  PartPlace place_;
  Strip strip_;
  std::optional<Strip> shared_;  // rows that the next process knows, too; none of the last one
  int shared_begin_ = 0;         // its first particle in the strip
  linear::SymmetricBlockMatrix matrix_;
  linear::BlockVector rhs_, solution_;
  PetscSystem system_;
  cloth::ClothState trial_;
  cloth::ClothState shared_trial_;
  double weight_ = 0.0;  // N, of the sheet under standard gravity
};

}  // namespace haptex::large
