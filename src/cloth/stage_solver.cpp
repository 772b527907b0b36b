#include "haptex/cloth/stage_solver.h"

#include <chrono>
#include <cmath>

namespace haptex::cloth {
namespace {

using Clock = std::chrono::steady_clock;
using Eigen::Vector3d;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Where the attached particle is in the stage.
Vector3d placeIn(const Stage& stage, const AttachmentPath& path, int particle) {
  return (1.0 - stage.share) * stage.base.positions[particle] +
         stage.share * path.position(stage.end);
}

}  // namespace

StageSolver::StageSolver(const Cloth& cloth, const StepSettings& settings)
    : settings_(settings),
      matrix_(cloth.pattern()),
      solver_(matrix_, settings.solver),
      rhs_(3, cloth.particleCount()),
      solution_(BlockVector::Zero(3, cloth.particleCount())),
      prescribed_(BlockVector::Zero(3, cloth.particleCount())),
      fixed_(cloth.particleCount(), 0) {
  if (settings.newton_iterations > 1) {
    trial_ = cloth.initialState();
    base_strains_.resize(cloth.membrane().elements().size());
  }
}

void StageSolver::solve(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                        ClothState& result, StepReport& report) {
  const Clock::time_point start = Clock::now();
  linearise(cloth, stage, guess);
  report.assembly_seconds += seconds(Clock::now() - start);
  report.linear_converged = solveLinear(report) && report.linear_converged;
  for (int i = 0; i < matrix_.size(); ++i) {
    result.velocities[i] = guess.velocities[i] + solution_.col(i);
    result.positions[i] = fixed_[i] ? placeIn(stage, *cloth.attachments()[i], i)
                                    : stage.base.positions[i] + stage.a * result.velocities[i];
  }
  if (settings_.newton_iterations == 1) return;
  if (stage.rates == Stage::Rates::kSinceBase) {
    cloth.membrane().computeStrains(stage.base.positions, base_strains_);
  } else {
    cloth.membrane().computeStrainsBefore(result.positions, result.velocities, stage.a,
                                          base_strains_);
  }
  iterateNewton(cloth, stage, result, report);
}

/// Inertia and the external forces that are constant over the step.
void StageSolver::addInertia(const Cloth& cloth, const Stage& stage, const Velocities& velocities) {
  matrix_.setZero();
  for (int i = 0; i < matrix_.size(); ++i) {
    const double mass = cloth.masses()[i];
    matrix_.diagonal(i).diagonal().setConstant(mass);
    rhs_.col(i) = stage.a * (cloth.externalForces()[i] + mass * cloth.effects().gravity) -
                  mass * (velocities[i] - stage.base.velocities[i]);
  }
}

void StageSolver::linearise(const Cloth& cloth, const Stage& stage, const StageGuess& guess) {
  addInertia(cloth, stage, guess.velocities);
  cloth.membrane().addStep(guess.positions, guess.velocities, {stage.a, guess.ahead}, matrix_,
                           rhs_);
  if (cloth.bending()) {
    cloth.bending()->addStep(guess.positions, guess.velocities, {stage.a, guess.ahead}, matrix_,
                             rhs_);
  }
  addPointLoadStep(cloth.pointLoads(), cloth.mesh().triangles, cloth.membrane().elements(),
                   guess.positions, guess.velocities, {stage.a, guess.ahead}, matrix_, rhs_);
  prescribe(cloth, stage, guess);
}

void StageSolver::prescribe(const Cloth& cloth, const Stage& stage, const StageGuess& guess) {
  any_fixed_ = false;
  for (int i = 0; i < matrix_.size(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    fixed_[i] = attachment.has_value();
    if (!attachment) continue;
    any_fixed_ = true;
    const Vector3d place = placeIn(stage, *attachment, i);
    prescribed_.col(i) = (place - stage.base.positions[i]) / stage.a - guess.velocities[i];
  }
  if (any_fixed_) matrix_.eliminate(fixed_, prescribed_, rhs_);
}

/// Solves matrix_ solution_ = rhs_ from the guess in solution_; false if that did not converge.
bool StageSolver::solveLinear(StepReport& report) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; any_fixed_ && i < matrix_.size(); ++i) {
    if (fixed_[i]) solution_.col(i).setZero();
  }
  const SolveResult result = solver_.solve(matrix_, rhs_, settings_.tolerance, solution_);
  for (int i = 0; any_fixed_ && i < matrix_.size(); ++i) {
    if (fixed_[i]) solution_.col(i) = prescribed_.col(i);
  }
  report.solver = solver_.lastMethod();
  report.linear_iterations += result.iterations;
  report.linear_residual = result.residual;
  ++report.newton_iterations;
  report.solve_seconds += seconds(Clock::now() - start);
  return result.converged;
}

double StageSolver::incrementalPotential(const Cloth& cloth, const Stage& stage,
                                         const ClothState& at) const {
  double potential = cloth.membrane().incrementalPotential(at.positions, base_strains_, stage.a) +
                     pointLoadEnergy(cloth.pointLoads(), cloth.mesh().triangles, at.positions);
  if (cloth.bending()) potential += cloth.bending()->energy(at.positions);
  for (int i = 0; i < matrix_.size(); ++i) {
    if (fixed_[i]) continue;
    const double mass = cloth.masses()[i];
    potential += 0.5 * mass * (at.velocities[i] - stage.base.velocities[i]).squaredNorm();
    potential -= (cloth.externalForces()[i] + mass * cloth.effects().gravity)
                     .dot(at.positions[i] - stage.base.positions[i]);
  }
  return potential;
}

void StageSolver::assembleNewton(const Cloth& cloth, const Stage& stage, const ClothState& at,
                                 Membrane::Hessian hessian, StepReport& report) {
  const Clock::time_point start = Clock::now();
  addInertia(cloth, stage, at.velocities);
  cloth.membrane().addNewton(at.positions, base_strains_, stage.a, hessian, matrix_, rhs_);
  if (cloth.bending()) {
    cloth.bending()->addStep(at.positions, at.velocities, {stage.a, 0.0}, matrix_, rhs_);
  }
  addPointLoadStep(cloth.pointLoads(), cloth.mesh().triangles, cloth.membrane().elements(),
                   at.positions, at.velocities, {stage.a, 0.0}, matrix_, rhs_);
  if (any_fixed_) matrix_.eliminate(fixed_, prescribed_, rhs_);
  report.assembly_seconds += seconds(Clock::now() - start);
}

void StageSolver::iterateNewton(const Cloth& cloth, const Stage& stage, ClothState& result,
                                StepReport& report) {
  constexpr double kNearMinimum = 1e-2;  // relative residual from which the exact Hessian is tried
  const double reference = rhs_.norm();
  const int most_solves = report.newton_iterations - 1 + settings_.newton_iterations;
  double potential = incrementalPotential(cloth, stage, result);
  prescribed_.setZero();  // the attached particles have reached their places
  bool converged = false;
  auto hessian = Membrane::Hessian::kProjected;
  while (true) {
    assembleNewton(cloth, stage, result, hessian, report);
    const double norm = rhs_.norm();
    report.newton_residual = reference > 0.0 ? norm / reference : norm;
    converged = norm <= settings_.newton_tolerance * reference;
    if (converged || report.newton_iterations >= most_solves) break;
    solution_.setZero();
    const bool solved = solveLinear(report);
    const bool exact = hessian == Membrane::Hessian::kExact;
    if (!exact) report.linear_converged = report.linear_converged && solved;
    const Descent descent = solved ? searchLine(cloth, stage, result, potential) : Descent::kNone;
    if (descent == Descent::kFound) {
      hessian = norm <= kNearMinimum * reference ? Membrane::Hessian::kExact
                                                 : Membrane::Hessian::kProjected;
    } else if (descent == Descent::kNone && exact) {  // not positive definite here
      hessian = Membrane::Hessian::kProjected;
    } else {
      converged = descent == Descent::kBelowRounding;
      break;
    }
  }
  report.newton_converged = report.newton_converged && converged;
}

/// Moves the result along solution_ to a lower potential.
StageSolver::Descent StageSolver::searchLine(const Cloth& cloth, const Stage& stage,
                                             ClothState& result, double& potential) {
  constexpr double kSufficientDecrease = 1e-4;
  constexpr double kRounding = 1e-14;
  constexpr int kMostHalvings = 40;
  const double descent = rhs_.cwiseProduct(solution_).sum();
  const bool below_rounding = std::abs(descent) <= kRounding * std::abs(potential);
  if (!(descent > 0.0)) return below_rounding ? Descent::kBelowRounding : Descent::kNone;
  double step = 1.0;
  for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
    for (int i = 0; i < matrix_.size(); ++i) {
      const Vector3d change = step * solution_.col(i);
      trial_.velocities[i] = result.velocities[i] + change;
      trial_.positions[i] = result.positions[i] + stage.a * change;
    }
    const double trial = incrementalPotential(cloth, stage, trial_);
    if (trial <= potential - kSufficientDecrease * step * descent || below_rounding) {
      std::swap(result.positions, trial_.positions);
      std::swap(result.velocities, trial_.velocities);
      potential = trial;
      return below_rounding ? Descent::kBelowRounding : Descent::kFound;
    }
  }
  return Descent::kNone;
}

}  // namespace haptex::cloth
