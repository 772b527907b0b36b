// The implicit stage that all implicit integrators are made of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptex/cloth/block_matrix.h"
#include "haptex/cloth/cloth.h"
#include "haptex/cloth/linear_solver.h"
#include "haptex/cloth/step.h"

namespace haptex::cloth {

/// Find (x, v) with
///   M (v - v*) = a F(x, v),  x = x* + a v.
struct Stage {
  const ClothState& base;  ///< x*, v*; its time is not read
  double a;                ///< s, finite and > 0
  double end;              ///< s, simulated, of the places of the attached particles
  double share;            ///< of the way from x* to their place that they go in the stage
  /// Strain rates of Newton iterations.
  enum class Rates {
    kSinceBase,     ///< (e - e*) / a, which vanishes under every rigid motion from x*
    kOfVelocities,  ///< of v, to the second order
  } rates;
};

/// Where the first linear solve of a stage linearises: (xg, vg), which reaches the stage in `ahead`
/// seconds,
///   x* + a vg = xg + ahead vg.
struct StageGuess {
  const Positions& positions;    ///< xg
  const Velocities& velocities;  ///< vg
  double ahead;                  ///< s, >= 0
};

/// Solves stages. The first linear solve of a stage linearises the forces about a guess (xg, vg),
///   (M - a D - a^2 K) (v - vg) = M (v* - vg) + a [F(xg, vg) + ahead K vg],
/// with K and D projected to be negative semidefinite, so that the matrix is positive definite for
/// every state and a (Baraff and Witkin 1998). With more than one Newton iteration it goes on from
/// there to the minimum of the incremental potential
///   |M^(1/2) (v - v*)|^2 / 2 + Membrane::incrementalPotential(x) - external forces . x
///   + pointLoadEnergy(x),
/// by Newton iterations with a backtracking line search. They use the projected Hessian as long as
/// the residual is large, and then the exact one where it is positive definite.
///
/// With xg and vg right to the first order in time the first solve is right to the second where
/// nothing had to be projected. It linearises about a state that has been reached, not about
/// xg + ahead vg: what turns is stretched there, and stiff fabrics that do not resist compression
/// then gain energy without bounds.
///
/// Allocates nothing after construction.
class StageSolver {
 public:
  /// @param settings sound (Integrator)
  StageSolver(const Cloth& cloth, const StepSettings& settings);

  int particleCount() const { return matrix_.size(); }

  /// @param result positions and velocities of the stage. May be what the guess refers to, not the
  ///   base.
  /// @param report adds to its counts and times; convergence stays false where it was
  void solve(const Cloth& cloth, const Stage& stage, const StageGuess& guess, ClothState& result,
             StepReport& report);

  /// The next solve starts from zero, not from the solution of the last.
  void forget() { solution_.setZero(); }

 private:
  enum class Descent { kFound, kBelowRounding, kNone };

  void linearise(const Cloth& cloth, const Stage& stage, const StageGuess& guess);
  void prescribe(const Cloth& cloth, const Stage& stage, const StageGuess& guess);
  bool solveLinear(StepReport& report);
  void iterateNewton(const Cloth& cloth, const Stage& stage, ClothState& result,
                     StepReport& report);
  void assembleNewton(const Cloth& cloth, const Stage& stage, const ClothState& at,
                      Membrane::Hessian hessian, StepReport& report);
  Descent searchLine(const Cloth& cloth, const Stage& stage, ClothState& result, double& potential);
  void addInertia(const Cloth& cloth, const Stage& stage, const Velocities& velocities);
  double incrementalPotential(const Cloth& cloth, const Stage& stage, const ClothState& at) const;

  StepSettings settings_;
  SymmetricBlockMatrix matrix_;
  LinearSolver solver_;
  BlockVector rhs_;
  BlockVector solution_;    // of the last linear system, with the prescribed values
  BlockVector prescribed_;  // velocity changes of the attached particles
  std::vector<char> fixed_;
  bool any_fixed_ = false;
  ClothState trial_;  // of a line search; empty with one Newton iteration
  std::vector<MembraneStrain> base_strains_;
};

}  // namespace haptex::cloth
