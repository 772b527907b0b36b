// Backward Euler integration of a cloth with user-chosen, non-uniform time steps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/cloth.h"
#include "haptex/cloth/linear_solver.h"

namespace haptex::cloth {

struct StepSettings {
  LinearSolverMethod solver = LinearSolverMethod::kAutomatic;
  /// Relative residual |b - A dv| / |b| that every linear solve aims at;
  /// StepReport::linear_converged tells whether it was reached.
  double tolerance = 1e-6;
  /// 1: the linearised step alone. More: Newton iterations with line search until the nonlinear
  /// residual falls below newton_tolerance times the right-hand side of the linearised step, or
  /// cannot fall any more for rounding, or this number is spent.
  int newton_iterations = 1;
  double newton_tolerance = 1e-8;
};

/// What a step did and took.
struct StepReport {
  bool accepted = false;  ///< false: system or result was not finite, the state is as before
  bool linear_converged = false;
  LinearSolverMethod solver = LinearSolverMethod::kCholesky;  ///< that gave the last solution
  int linear_iterations = 0;     ///< conjugate gradient iterations of all solves
  double linear_residual = 0;    ///< relative, of the last solve
  int newton_iterations = 0;     ///< linear solves
  double newton_residual = 0;    ///< relative to the linearised step's right-hand side, which is
                                 ///< rounding itself when the cloth is at rest; 0 if not asked for
  bool newton_converged = true;  ///< to newton_tolerance or to rounding
  double assembly_seconds = 0;
  double solve_seconds = 0;
  double total_seconds = 0;
};

/// One step solves (M - h D - h^2 K) dv = h (F + h K v), then v += dv, x += h v (Baraff and Witkin
/// 1998), with K and D projected to be negative semidefinite, so that the matrix is positive
/// definite for every state and step. Attached particles reach their place exactly at the end of
/// the step. With more than one Newton iteration the step goes on from there to the minimum of the
/// incremental potential of backward Euler,
///   |M^(1/2) (v - v0)|^2 / 2 + Membrane::incrementalPotential(x) - external forces . x
///   + pointLoadEnergy(x),
/// by Newton iterations with a backtracking line search. They use the projected Hessian as long as
/// the residual is large, and then the exact one where it is positive definite.
///
/// A step allocates nothing: all buffers are made by the constructor.
class BackwardEuler {
 public:
  /// @throws std::invalid_argument if the settings' tolerances are not in (0, 1) or
  ///   newton_iterations is less than 1
  BackwardEuler(const Cloth& cloth, const StepSettings& settings);

  /// Advances `state` by `time_step` seconds; steps need not be uniform.
  /// @param cloth that of the constructor; its fabric, loads and attachments may have changed,
  ///   but not Cloth::pattern()
  /// @throws std::invalid_argument if the time step is not finite and > 0, or state and cloth
  ///   differ in size from each other or from the constructor's; the state is then as before
  StepReport step(const Cloth& cloth, ClothState& state, double time_step);

 private:
  void prescribe(const Cloth& cloth, const ClothState& state, double time_step);
  bool solveLinear(StepReport& report);
  void iterateNewton(const Cloth& cloth, const ClothState& begin, double h, StepReport& report);
  void assembleNewton(const Cloth& cloth, const ClothState& begin, double h,
                      Membrane::Hessian hessian, StepReport& report);
  enum class Descent { kFound, kBelowRounding, kNone };
  Descent searchLine(const Cloth& cloth, const ClothState& begin, double h, double& potential);
  double incrementalPotential(const Cloth& cloth, const ClothState& begin, double h,
                              const Positions& positions, const Velocities& velocities) const;

  StepSettings settings_;
  std::size_t element_count_;
  std::size_t coupling_count_;  // of bending
  SymmetricBlockMatrix matrix_;
  LinearSolver solver_;
  BlockVector rhs_;
  BlockVector solution_;    // of the last linear system, with the prescribed values
  BlockVector prescribed_;  // velocity changes of the attached particles
  std::vector<char> fixed_;
  bool any_fixed_ = false;
  ClothState end_;    // the step's result before it is accepted
  ClothState trial_;  // of a line search; empty with one Newton iteration
  std::vector<MembraneStrain> begin_strains_;
};

}  // namespace haptex::cloth
