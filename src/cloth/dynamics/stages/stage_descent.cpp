// Stages whose first solve has gone too far.
#include <algorithm>
#include <cmath>
#include <utility>

#include "haptex/cloth/dynamics/stages/stage_solver.h"

namespace haptex::cloth {

using Eigen::Vector3d;

void StageSolver::beginAnew(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                            ClothState& result, StepReport& report) {
  const MotionCut cut = report.self_cut;
  std::swap(trial_.positions, result.positions);
  solveLinearised(cloth, stage, guess, result, report);
  if (touching() || settings_.newton_iterations == 1) return;
  for (int i = 0; i < matrix_.size(); ++i) {
    trial_.velocities[i] = (trial_.positions[i] - stage.base.positions[i]) / stage.a;
  }
  hold(cloth, stage, stage.base, true);
  const double found = incrementalPotential(cloth, stage, trial_);
  const double linearised = incrementalPotential(cloth, stage, result);
  if (!std::isfinite(found) || found >= linearised) return;
  std::swap(trial_.positions, result.positions);
  std::swap(trial_.velocities, result.velocities);
  report.self_cut = cut;
}

bool StageSolver::descend(const Cloth& cloth, const Stage& stage,
                          const std::function<bool()>& enough, ClothState& result,
                          StepReport& report) {
  // Where the cloth touches, a Newton iteration takes several; with 20 of them impacts of wool
  // gained up to 0.4 mJ (3 % of weight by size).
  constexpr int kMinSolves = 20, kMinTouchingSolves = 60;
  constexpr int kSolvesBeforeRetreat = 4;
  hold(cloth, stage, stage.base, true);
  double potential = incrementalPotential(cloth, stage, result);
  const auto iterate = [&](int most_solves) {
    return iterateNewton(cloth, stage, potential, most_solves, enough, result, report);
  };
  if (touching()) return iterate(std::max(kMinTouchingSolves, settings_.newton_iterations));
  // What collides is ahead of obstacles, and a way back to lower potentials may lead around them.
  if (std::isfinite(potential) && report.self_cut.particles == 0) {
    if (movesFreely() && calmEdges(cloth, stage, potential, result) && enough()) return true;
    const bool converged = report.newton_converged;
    if (iterate(kSolvesBeforeRetreat)) return true;
    report.newton_converged = converged;  // the iterations that follow tell
  }
  potential = retreatTowardsRest(cloth, stage, result, report);
  return iterate(std::max(kMinSolves, settings_.newton_iterations));
}

/// Limits relative motion if that alone takes away nearly all by which the potential is above that
/// of the step's beginning: then the solve went wrong in a few places only, and all others can stay
/// where they are.
/// @param potential incremental one of the result (J); changed with it
bool StageSolver::calmEdges(const Cloth& cloth, const Stage& stage, double& potential,
                            ClothState& result) {
  constexpr double kMostLeft = 0.05;
  trial_.positions = result.positions;
  trial_.velocities = result.velocities;
  if (!limitRelativeMotion(cloth, stage, trial_)) return false;
  sew(cloth, stage, trial_);
  const double at_begin = incrementalPotential(cloth, stage, stage.base);
  const double calm = incrementalPotential(cloth, stage, trial_);
  if (!(potential > at_begin && calm - at_begin < kMostLeft * (potential - at_begin))) return false;
  potential = calm;
  std::swap(result.positions, trial_.positions);
  std::swap(result.velocities, trial_.velocities);
  return true;
}

/// If the potential of the free particles at x*, without velocity, is lower, halves their way from
/// there until it is not.
/// @return the incremental potential of the result
double StageSolver::retreatTowardsRest(const Cloth& cloth, const Stage& stage, ClothState& result,
                                       StepReport& report) {
  constexpr double kMinShare = 1e-9;
  MotionCut cut;
  const auto place_at = [&](double share) {
    for (int i = 0; i < matrix_.size(); ++i) {
      const Vector3d velocity = result.velocities[i];
      trial_.velocities[i] = fixed_[i] ? velocity : Vector3d::Zero();
      if (!fixed_[i] && share > 0.0) trial_.velocities[i] = share * velocity;
      trial_.positions[i] = fixed_[i] ? result.positions[i]
                                      : stage.base.positions[i] + stage.a * trial_.velocities[i];
    }
    sew(cloth, stage, trial_);
    cut = keepApart(cloth, stage, start_, trial_);
    return incrementalPotential(cloth, stage, trial_);
  };
  const double at_rest = place_at(0.0);
  double potential = incrementalPotential(cloth, stage, result);
  if (potential <= at_rest) return potential;
  double share = 1.0;
  do {
    share = share > kMinShare ? 0.5 * share : 0.0;
    potential = place_at(share);
  } while (!(potential <= at_rest) && share > 0.0);
  std::swap(result.positions, trial_.positions);
  std::swap(result.velocities, trial_.velocities);
  report.self_cut = cut;
  return potential;
}

}  // namespace haptex::cloth
