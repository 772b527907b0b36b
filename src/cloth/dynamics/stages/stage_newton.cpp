// The Newton iterations of a stage.
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "haptex/cloth/dynamics/stages/stage_solver.h"

namespace haptex::cloth {
namespace {

/// Whether an edge of the cloth at a contact that holds has turned by more than 0.02 rad in the
/// stage. A solve moves particles along their tangents, which stretches what turns by an angle a by
/// a^2/2, and friction multiplies that tension around the obstacle: of 0.06 rad two solves leave up
/// to 1.6 % in the capstan equation, five 0.1 %; of 0.016 rad 0.3 and 0.2 %.
/// @param pattern with a block for every edge
bool touchingTurns(const Cloth& cloth, const std::vector<ContactReaction>& reactions,
                   const linear::SymmetricBlockMatrix& pattern, double a,
                   const ClothState& result) {
  constexpr double kTurn = 0.02;  // rad
  for (std::size_t c = 0; c < reactions.size(); ++c) {
    if (reactions[c].state == ContactReaction::State::kOpen) continue;
    const int i = cloth.contacts()[c].particle;
    for (int slot = pattern.rowBegin(i); slot < pattern.rowBegin(i + 1); ++slot) {
      const int j = pattern.column(slot);
      const Eigen::Vector3d edge = result.positions[j] - result.positions[i];
      const Eigen::Vector3d change = a * (result.velocities[j] - result.velocities[i]);
      if (edge.cross(change).norm() > kTurn * edge.squaredNorm()) return true;
    }
  }
  return false;
}

}  // namespace

/// @param potential incremental one of the result
/// @param most_solves linear ones
/// @param enough may be empty
/// @return whether the result is enough
bool StageSolver::iterateNewton(const Cloth& cloth, const Stage& stage, double potential,
                                int most_solves, const std::function<bool()>& enough,
                                ClothState& result, StepReport& report) {
  constexpr double kNearMinimum = 1e-2;  // relative residual from which the exact Hessian is tried
  constexpr double kNearer = 0.1;        // of the residual where it was not positive definite
  double reference = linearised_norm_;   // of a start without first solve, its own residual
  double near = kNearMinimum * reference;
  constexpr int kLeastTurning = 5;  // solves where cloth turns that touches
  const int last_solve = report.newton_iterations + most_solves;
  int beyond = 0;
  prescribed_.setZero();  // the fixed particles have reached their places
  bool converged = false, is_enough = false;
  int solves = linearised_norm_ > 0.0 ? 1 : 0;  // of the stage
  auto hessian = Hessian::kProjected;
  while (true) {
    assembleNewton(cloth, stage, result, hessian, report);
    const double norm = touching() ? contacts_->residualNorm(rhs_) : rhs_.norm();
    if (reference == 0.0) near = kNearMinimum * (reference = norm);
    report.newton_residual = reference > 0.0 ? norm / reference : norm;
    // No Hessian of a stage is less than the masses, so a step promises at most this.
    const bool is_small = solves > 0 && isSmallError(norm / stage.a, norm * norm / least_mass_);
    converged = norm <= settings_.newton_tolerance * reference || is_small;
    if (converged) break;
    if (report.newton_iterations >= last_solve) {
      const bool goes_on = beyond < mostBeyond(report, !enough);
      ++beyond;
      const bool turns = solves < kLeastTurning && touching() &&
                         touchingTurns(cloth, contacts_->reactions(), matrix_, stage.a, result);
      if (!goes_on && !turns) break;
    }
    solution_.setZero();
    ++solves;
    const bool exact = hessian == Hessian::kExact;
    const auto definiteness = exact ? linear::LinearSolver::Definiteness::kUnknown
                                    : linear::LinearSolver::Definiteness::kPositive;
    const bool solved = touching() ? solveTouching(result.velocities, report, definiteness)
                                   : solveLinear(report, definiteness);
    if (touching()) {
      contacts_->moveBodies(0.0);
      potential = incrementalPotential(cloth, stage, result);  // of this friction
      contacts_->moveBodies(exact && !solved ? 0.0 : 1.0);
    }
    const bool is_last = solved && isSmallError(norm / stage.a, decrease());
    if (!exact) report.linear_converged = report.linear_converged && solved;
    // Of the projected Hessian an inexact solution will do: the line search judges it.
    const Descent descent =
        solved || !exact ? searchLine(cloth, stage, result, potential, report) : Descent::kNone;
    if (descent == Descent::kFound || descent == Descent::kLimited) {
      const bool enters =
          touching() && contacts_->enter(result.velocities, 2.0 * kContactPenetration);
      is_enough = enough && !enters && enough();
      if (is_enough) break;
      converged =
          is_last && descent == Descent::kFound && !enters && report.self_cut.particles == 0;
      if (converged) break;
      hessian = norm <= near ? Hessian::kExact : Hessian::kProjected;
    } else if (descent == Descent::kNone && exact) {  // not positive definite here
      hessian = Hessian::kProjected;
      near = kNearer * norm;
    } else {
      converged = descent == Descent::kBelowRounding;
      break;
    }
  }
  report.newton_converged = report.newton_converged && converged;
  return is_enough;
}

/// Iterations beyond what was asked for, of cloth that collides with itself: to the error that is
/// asked for, or as long as the last one was cut. Short of the error, stiff layers hook into each
/// other. (Whether layers are near does not tell: one bad step before they are is enough.)
int StageSolver::mostBeyond(const StepReport& report, bool to_error) const {
  constexpr int kWhileCut = 20, kToError = 40;
  if (!motion_) return 0;
  if (to_error && settings_.newton_error > 0.0) return kToError;
  return report.self_cut.particles > 0 ? kWhileCut : 0;
}

/// Of the incremental potential along the solution (J), to the first order: twice what a Newton
/// step promises.
double StageSolver::decrease() const {
  return touching() ? contacts_->descent(solution_) : rhs_.cwiseProduct(solution_).sum();
}

/// What StepSettings::newton_error says. @param force N @param decrease decrease()
bool StageSolver::isSmallError(double force, double decrease) const {
  return force <= force_error_ && 0.5 * decrease <= energy_error_;
}

bool StageSolver::limitRelativeMotion(const Cloth& cloth, const Stage& stage, ClothState& at) {
  return relative_motion_.apply(cloth, fixed_, stage.base.positions, stage.a, at, pool_.get());
}

/// Moves the result along solution_ to a lower potential. If the whole way is too far, what moves
/// apart on it is slowed down before all of it is shortened.
StageSolver::Descent StageSolver::searchLine(const Cloth& cloth, const Stage& stage,
                                             ClothState& result, double& potential,
                                             StepReport& report) {
  constexpr double kSufficientDecrease = 1e-4;
  constexpr double kRounding = 1e-14;
  constexpr int kMaxHalvings = 40;
  const double descent = decrease();
  const bool below_rounding = std::abs(descent) <= kRounding * std::abs(potential);
  if (!(descent > 0.0)) return below_rounding ? Descent::kBelowRounding : Descent::kNone;
  const auto try_step = [&](double step, bool limited) {
    for (int i = 0; i < matrix_.size(); ++i) {
      const Eigen::Vector3d change = step * solution_.col(i);
      trial_.velocities[i] = result.velocities[i] + change;
      trial_.positions[i] = result.positions[i] + stage.a * change;
    }
    if (limited) {
      sew(cloth, stage, trial_);
      if (!limitRelativeMotion(cloth, stage, trial_)) return false;
    }
    sew(cloth, stage, trial_);
    const MotionCut cut = keepApart(cloth, stage, result.positions, trial_);
    if (touching()) contacts_->moveBodies(step);
    const double trial = incrementalPotential(cloth, stage, trial_);
    // What was limited or cut has not gone along the line: any decrease will do.
    const bool on_line = !limited && cut.particles == 0;
    const double sufficient = on_line ? kSufficientDecrease * step * descent : 0.0;
    if (!(trial <= potential - sufficient || below_rounding)) return false;
    report.self_cut = cut;
    std::swap(result.positions, trial_.positions);
    std::swap(result.velocities, trial_.velocities);
    potential = trial;
    if (touching()) contacts_->shorten(step);
    return true;
  };
  const Descent found = below_rounding ? Descent::kBelowRounding : Descent::kFound;
  if (try_step(1.0, false)) return found;
  if (movesFreely() && try_step(1.0, true)) return Descent::kLimited;
  double step = 0.5;
  for (int halving = 1; halving < kMaxHalvings; ++halving, step *= 0.5) {
    if (try_step(step, false)) return found;
  }
  if (touching()) contacts_->shorten(0.0);
  return Descent::kNone;
}

}  // namespace haptex::cloth
