// The implicit stage that all implicit integrators are made of.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/active_set_contact_solver.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/safe_motion.h"
#include "haptex/cloth/dynamics/stage.h"
#include "haptex/cloth/dynamics/stages/relative_motion.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/linear/block_matrix.h"
#include "haptex/linear/linear_solver.h"
#include "haptex/linear/thread_pool.h"

namespace haptex::cloth {

/// Solves stages. The first linear solve of a stage linearises the forces about a guess (xg, vg),
///   (M - a D - a^2 K) (v - vg) = M (v* - vg) + a [F(xg, vg) + ahead K vg],
/// with K and D projected to be negative semidefinite, so that the matrix is positive definite for
/// every state and a (Baraff and Witkin 1998). With more than one Newton iteration it goes on from
/// there to the minimum of the incremental potential
///   |M^(1/2) (v - v*)|^2 / 2 + Force::incrementalPotential(x, v) of all forces,
/// by Newton iterations with a backtracking line search, which first limits the relative motion on
/// a whole step that does not lower it (RelativeMotionLimit). They use the projected Hessian as
/// long as the residual is large, and then the exact one where it is positive definite. What forces
/// hold fixed meanwhile is that of the first solve, right to the second order.
///
/// With xg and vg right to the first order in time the first solve is right to the second where
/// nothing had to be projected. It linearises about a state that has been reached, not about
/// xg + ahead vg: what turns is stretched there, and stiff fabrics that do not resist compression
/// then gain energy without bounds.
///
/// Contacts of the cloth hold as ActiveSetContactSolver says; every linear solve of a stage is then
/// repeated until they are found.
///
/// Where the cloth collides with itself, the first solve's result and every trial of a line search
/// are taken as far only as they can be reached without passing through (SafeMotion), and
/// velocities follow; Newton iterations go on for a while as long as something is cut, or
/// StepSettings::newton_error is missed, whatever else the settings say. Obstacles go through the
/// step before, and what they carry with them is where the first solve's way begins. That holds for
/// stages from the beginning of a step, x* = x0, alone.
///
/// Allocates nothing after construction, but where more of the cloth is near itself than before.
class StageSolver {
 public:
  /// @param settings sound (Integrator)
  StageSolver(const Cloth& cloth, const StepSettings& settings);

  int particleCount() const { return matrix_.size(); }
  /// Of the settings' threads; null if that is one.
  linear::ThreadPool* pool() const { return pool_.get(); }

  /// @param result positions and velocities of the stage. May be what the guess refers to, not the
  ///   base.
  /// @param report adds to its counts and times; convergence stays false where it was
  void solve(const Cloth& cloth, const Stage& stage, const StageGuess& guess, ClothState& result,
             StepReport& report);

  /// Begins a step anew that another method has taken to `result`: with the linearised stage, or,
  /// if that has the higher incremental potential, with the positions of the result and velocities
  /// (x - x*) / a. Always with the linearised stage where a stage has one solve, which may have
  /// gone anywhere, and where contacts are known, which remember the last solve alone.
  /// @param result in and out; neither stage nor guess may refer to it
  void beginAnew(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                 ClothState& result, StepReport& report);

  /// Newton iterations whatever the settings say, from the result of the last solve() or
  /// beginAnew(), which was of this stage, with relative motion limited where that is nearly
  /// all that was wrong (RelativeMotionLimit). If a few of them are not enough and rest has a
  /// lower incremental potential, they go on from where the straight way there first has: so that
  /// of the result is at most that of rest, unless it is enough. What forces hold is of the base,
  /// and passive (NewtonStart). Of cloth that collides with itself no motion is limited; where it
  /// was cut, rest is looked at before anything else. Where contacts hold, nothing is limited
  /// either, and rest, which is none of their states, is not looked at.
  /// @param enough of a result: it needs no more iterations
  /// @return whether that ended them, so that `enough` was last asked of the result
  bool descend(const Cloth& cloth, const Stage& stage, const std::function<bool()>& enough,
               ClothState& result, StepReport& report);

  /// Where small ways of single particles take the cloth in a step: the solution d of
  ///   (M - h D - h^2 K) d = M w,
  /// what impulses M w / h do in it, in matrices of a state as those of a first solve.
  /// @param at   state, h s
  /// @param ways m, w; then d. Zero of attached particles
  void respond(const Cloth& cloth, const ClothState& at, double h,
               std::vector<Eigen::Vector3d>& ways);

  /// The next solve starts from zero, not from the solution of the last.
  void forget() { solution_.setZero(); }

  /// Null if the cloth has been modelled without contacts.
  const ActiveSetContactSolver* contacts() const { return contacts_ ? &*contacts_ : nullptr; }
  ActiveSetContactSolver* contacts() { return contacts_ ? &*contacts_ : nullptr; }

 private:
  enum class Descent { kFound, kLimited, kBelowRounding, kNone };

  ForceState forceState(const Stage& stage, const Positions& positions,
                        const Velocities& velocities) const;
  void startFrom(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                 ClothState& result);
  void solveLinearised(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                       ClothState& result, StepReport& report);

  void hold(const Cloth& cloth, const Stage& stage, const ClothState& at, bool passive);
  void moveObstacles(const Cloth& cloth, const StageGuess& guess, StepReport& report);
  MotionCut keepApart(const Cloth& cloth, const Stage& stage, const Positions& from,
                      ClothState& at);
  bool calmEdges(const Cloth& cloth, const Stage& stage, double& potential, ClothState& result);
  double retreatTowardsRest(const Cloth& cloth, const Stage& stage, ClothState& result,
                            StepReport& report);
  void linearise(const Cloth& cloth, const Stage& stage, const StageGuess& guess);
  void prescribe(const Cloth& cloth, const Stage& stage, const StageGuess& guess);
  StageGuess sewn(const Cloth& cloth, const Stage& stage, const StageGuess& guess);
  void sew(const Cloth& cloth, const Stage& stage, ClothState& at) const;
  void eliminate();
  bool solveFirst(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                  StepReport& report);
  bool solveLinear(StepReport& report, linear::LinearSolver::Definiteness definiteness =
                                           linear::LinearSolver::Definiteness::kPositive);
  bool solveTouching(const Velocities& velocities, StepReport& report,
                     linear::LinearSolver::Definiteness definiteness =
                         linear::LinearSolver::Definiteness::kPositive);
  void moveBodies(linear::LinearSolver::Definiteness definiteness, StepReport& report);
  bool touching() const { return contacts_ && !contacts_->empty(); }
  /// Neither contacts nor other layers of the cloth are in its way.
  bool movesFreely() const { return !touching() && !motion_; }
  bool iterateNewton(const Cloth& cloth, const Stage& stage, double potential, int most_solves,
                     const std::function<bool()>& enough, ClothState& result, StepReport& report);
  int mostBeyond(const StepReport& report, bool to_error) const;
  void assembleNewton(const Cloth& cloth, const Stage& stage, const ClothState& at, Hessian hessian,
                      StepReport& report);
  bool limitRelativeMotion(const Cloth& cloth, const Stage& stage, ClothState& at);
  double decrease() const;
  bool isSmallError(double force, double decrease) const;
  Descent searchLine(const Cloth& cloth, const Stage& stage, ClothState& result, double& potential,
                     StepReport& report);
  double incrementalPotential(const Cloth& cloth, const Stage& stage, const ClothState& at) const;

  StepSettings settings_;
  double force_error_ = 0.0;                  // N, that a stage may have; 0: is not asked
  double energy_error_ = 0.0;                 // J, likewise
  double least_mass_ = 0.0;                   // kg, of a particle
  std::unique_ptr<linear::ThreadPool> pool_;  // null with one thread
  linear::SymmetricBlockMatrix matrix_;
  linear::LinearSolver solver_;
  linear::BlockVector rhs_;
  linear::BlockVector solution_;    // of the last linear system, with the prescribed values
  linear::BlockVector prescribed_;  // velocity changes of the attached particles
  double linearised_norm_ = 0.0;    // N s, of the right-hand side of the linearised stage
  double round_norm_ = 0.0;         // N s, likewise of the last round of contacts
  std::vector<char> fixed_;         // attached or tied
  bool any_fixed_ = false;
  std::optional<ActiveSetContactSolver> contacts_;
  std::optional<SafeMotion> motion_;  // if the cloth collides with itself
  Velocities sewn_velocities_;        // m/s, of sewn(); empty without ties
  Positions start_;                   // m, likewise: that of the step beside moved obstacles
  linear::BlockVector response_;      // m, of respond()
  linear::BlockVector load_change_;   // of the solution, by other loads of friction
  ClothState trial_;                  // of a line search, and of beginAnew()
  RelativeMotionLimit relative_motion_;
  std::vector<Eigen::Vector3d> held_;  // by the forces: Force::hold()
};

}  // namespace haptex::cloth
