// Integration of a cloth in time with user-chosen, non-uniform time steps.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/energy_balance.h"
#include "haptex/cloth/dynamics/explicit_step.h"
#include "haptex/cloth/dynamics/recent_motion.h"
#include "haptex/cloth/dynamics/stages/stage_solver.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/cloth/dynamics/untangling/untangling.h"

namespace haptex::cloth {

/// Advances a cloth by the method of its settings. Attached particles reach their place exactly at
/// the end of each step. What each method computes: docs/mechanics.md, section Step.
///
/// BDF-2 remembers the step before. It starts anew, with a step of TR-BDF2, where it is given a
/// state other than the one it left, or more than twice the time step before (it is stable up to
/// 1 + sqrt 2).
///
/// Implicit methods keep the cloth's contacts. A particle that touches a body goes with it at the
/// end of the step: along the normal where it slips, altogether where it sticks, so that impacts
/// are inelastic. BDF-2 starts anew after a step in which something touched.
///
/// Implicit methods gain no energy beyond the work that is done on the cloth and what it lost in
/// the last steps (EnergyBalance). What a linearised stage, a buckling element or a solver's
/// tolerance adds beyond is taken out of the velocities. Where that would be more than a tenth of
/// the kinetic energy, or a number is not finite, the step is taken anew by backward Euler, from
/// what the method has found if that is better than a linearised step (StageSolver::beginAnew()):
/// what moves apart in it is slowed down, and Newton iterations go on from there until it
/// is less; with every one but the first twice as much may be taken, up to all
/// (StageSolver::descend()).
///
/// Backward Euler keeps a cloth that collides with itself free of intersections, if it was
/// (StageSolver), and pulls it apart if it was not (Untangling); so do TR-BDF2 and BDF-2 where
/// there are no obstacles. The other methods refuse it.
///
/// A step allocates nothing: all buffers are made by the constructor, and only those that the
/// method needs.
class Integrator {
 public:
  /// @throws std::invalid_argument if the settings' tolerances are not in (0, 1),
  ///   newton_iterations is less than 1, threads is not from 1 to kMaxThreads, or the cloth
  ///   collides with itself and the method does not know that, or there are rigid bodies that
  ///   it does not know (knowsBodies())
  Integrator(const Cloth& cloth, const StepSettings& settings);

  /// Advances `state` by `time_step` seconds; steps need not be uniform.
  /// @param cloth that of the constructor; its fabric, loads and attachments may have changed,
  ///   but not Cloth::pattern()
  /// @throws std::invalid_argument if the time step is not finite and > 0, or state and cloth
  ///   differ in size from each other or from the constructor's; the state is then as before
  StepReport step(const Cloth& cloth, ClothState& state, double time_step);

  /// What the contacts of the cloth did in the last step, in their order: in its last stage, whose
  /// forces are those at the end of the step but for the midpoint method. Empty with an explicit
  /// method or a cloth without contacts.
  const std::vector<ContactReaction>& contactReactions() const;
  /// How the cloth's rigid bodies went through the last step, in their order. Empty with an
  /// explicit method, or a cloth without contacts.
  const std::vector<BodyMotion>& bodyMotions();

 private:
  /// What BDF-2 needs of the past.
  struct History {
    ClothState before;       // one step before `last`
    ClothState last;         // as step() left it
    double time_step = 0.0;  // s, between the two; 0: nothing has been
  };

  void keepEnergy(const Cloth& cloth, const ClothState& begin, double h, StepReport& report);
  void slowDown(const Cloth& cloth, double energy, StepReport& report);
  void followTies(const Cloth& cloth);
  void advance(const Cloth& cloth, const ClothState& begin, double h, StepReport& report);
  void runMidpoint(const Cloth& cloth, const ClothState& begin, double h, StepReport& report);
  double outerWork(const Cloth& cloth, const ClothState& begin, double h, double theta);
  double blendAgainstGrowth(const Cloth& cloth, const ClothState& begin, double allowed) const;
  void extrapolate(const Cloth& cloth, const ClothState& begin, double theta);
  bool predicts() const { return settings_.newton_error > 0.0; }
  void runTrBdf2(const Cloth& cloth, const ClothState& begin, double h, StepReport& report);
  void runBdf2(const Cloth& cloth, const ClothState& before, const ClothState& middle, double first,
               double second, StepReport& report);
  bool continuesHistory(const ClothState& begin, double h) const;
  bool touches() const;
  void settle(Velocities& velocities);
  void keep(const Cloth& cloth, ClothState& state, double h, bool anew, double energy_taken);

  StepSettings settings_;
  int pattern_size_;       // of the cloth's matrix
  std::size_t held_size_;  // of its forces
  std::size_t bodies_;     // of the cloth
  ClothState end_;         // the step's result before it is accepted
  std::optional<StageSolver> stages_;
  std::optional<ExplicitStep> explicit_step_;
  std::optional<EnergyBalance> balance_;  // of implicit methods
  ClothState base_;                       // of a stage that does not start at the beginning
  std::vector<Eigen::Vector3d> forces_;   // N, of the midpoint method
  std::optional<History> history_;
  std::optional<Untangling> untangling_;  // of a cloth that collides with itself
  std::optional<RecentMotion> motion_;    // of TR-BDF2 and BDF-2 where Newton iterations need it
};

}  // namespace haptex::cloth
