#include "haptex/cloth/dynamics/stages/stage_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "haptex/base/constants.h"
#include "haptex/cloth/forces/element_assembly.h"

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

/// When the forces of the stage act (s, simulated).
double timeOf(const Stage& stage) {
  return (1.0 - stage.share) * stage.base.time + stage.share * stage.end;
}

/// m^2
double restArea(const mesh::ClothMesh& mesh) {
  double area = 0.0;
  for (const MembraneElement& element : restElements(mesh)) area += element.area;
  return area;
}

/// Of a particle that is not tied (kg).
double leastMass(const Cloth& cloth) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.ties().isTied(static_cast<int>(i))) least = std::min(least, cloth.masses()[i]);
  }
  return least;
}

/// How far a tied particle is from its place at the beginning and at the end of a stage (m).
struct StageGaps {
  StageGaps(const Ties& ties, const Stage& stage, std::size_t tie) {
    const Positions& base = stage.base.positions;
    begin = base[ties.resolved()[tie].particle] - ties.mean(tie, base);
    end = (1.0 - stage.share) * begin + stage.share * ties.gap(tie, stage.end);
  }
  Vector3d begin, end;
};

}  // namespace

StageSolver::StageSolver(const Cloth& cloth, const StepSettings& settings)
    : settings_(settings),
      pool_(settings.threads > 1 ? std::make_unique<linear::ThreadPool>(settings.threads)
                                 : nullptr),
      matrix_(cloth.pattern()),
      solver_(matrix_, settings.solver, pool_.get()),
      rhs_(3, cloth.particleCount()),
      solution_(linear::BlockVector::Zero(3, cloth.particleCount())),
      prescribed_(linear::BlockVector::Zero(3, cloth.particleCount())),
      fixed_(cloth.particleCount(), 0),
      relative_motion_(cloth) {
  if (cloth.effects().contacts && !cloth.effects().self_collision) {
    contacts_.emplace(matrix_, cloth.bodies());
    load_change_ = solution_;
  }
  if (const SelfContact* self = cloth.selfContact()) {
    motion_.emplace(cloth.particleCount(), self->margin(), self->particleMargins(), pool_.get());
    response_ = solution_;
  }
  if (!cloth.ties().empty()) sewn_velocities_.resize(cloth.particleCount());
  trial_ = cloth.initialState();
  held_.assign(cloth.forces().heldSize(), Vector3d::Zero());
  if (settings.newton_error > 0.0) {
    const double weight =
        base::kStandardGravity * std::accumulate(cloth.masses().begin(), cloth.masses().end(), 0.0);
    least_mass_ = leastMass(cloth);
    force_error_ = settings.newton_error * weight;
    energy_error_ = settings.newton_error * force_error_ * std::sqrt(restArea(cloth.mesh()));
  }
}

void StageSolver::solve(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                        ClothState& result, StepReport& report) {
  const bool predicted =
      guess.predicted != nullptr && cloth.contacts().empty() && cloth.selfContact() == nullptr;
  if (predicted) {
    startFrom(cloth, stage, guess, result);
  } else {
    solveLinearised(cloth, stage, guess, result, report);
  }
  if (settings_.newton_iterations == 1 && report.self_cut.particles == 0) return;
  hold(cloth, stage, result, false);
  iterateNewton(cloth, stage, incrementalPotential(cloth, stage, result),
                settings_.newton_iterations - (predicted ? 0 : 1), {}, result, report);
}

/// At the predicted positions, with the attached particles in their places.
void StageSolver::startFrom(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                            ClothState& result) {
  prescribe(cloth, stage, guess);
  if (contacts_) contacts_->begin(cloth, stage, guess.velocities, fixed_);
  linearised_norm_ = 0.0;
  for (int i = 0; i < matrix_.size(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    result.positions[i] = attachment ? placeIn(stage, *attachment, i) : (*guess.predicted)[i];
    result.velocities[i] = (result.positions[i] - stage.base.positions[i]) / stage.a;
  }
  sew(cloth, stage, result);
}

void StageSolver::solveLinearised(const Cloth& cloth, const Stage& stage, const StageGuess& given,
                                  ClothState& result, StepReport& report) {
  const Clock::time_point start = Clock::now();
  const StageGuess guess = sewn(cloth, stage, given);
  moveObstacles(cloth, guess, report);
  linearise(cloth, stage, guess);
  report.assembly_seconds += seconds(Clock::now() - start);
  report.linear_converged = solveFirst(cloth, stage, guess, report) && report.linear_converged;
  for (int i = 0; i < matrix_.size(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    result.velocities[i] = guess.velocities[i] + solution_.col(i);
    result.positions[i] = attachment ? placeIn(stage, *attachment, i)
                                     : stage.base.positions[i] + stage.a * result.velocities[i];
  }
  sew(cloth, stage, result);
  report.self_cut = keepApart(cloth, stage, start_, result);
}

/// What forces of the stage depend on, with what they remember from the beginning of the step.
ForceState StageSolver::forceState(const Stage& stage, const Positions& positions,
                                   const Velocities& velocities) const {
  return {positions, velocities, timeOf(stage), stage.base.memory.data(), nullptr, pool_.get()};
}

/// The guess with velocities that take tied particles to their places, so that the solution changes
/// them as the particles that they are tied to.
StageGuess StageSolver::sewn(const Cloth& cloth, const Stage& stage, const StageGuess& guess) {
  const Ties& ties = cloth.ties();
  if (ties.empty()) return guess;
  sewn_velocities_ = guess.velocities;
  for (std::size_t t = 0; t < ties.resolved().size(); ++t) {
    const StageGaps gaps(ties, stage, t);
    sewn_velocities_[ties.resolved()[t].particle] =
        ties.mean(t, sewn_velocities_) + (gaps.end - gaps.begin) / stage.a;
  }
  return {guess.positions, sewn_velocities_, guess.ahead, guess.predicted};
}

/// Tied particles go where they are sewn.
void StageSolver::sew(const Cloth& cloth, const Stage& stage, ClothState& at) const {
  const Ties& ties = cloth.ties();
  for (std::size_t t = 0; t < ties.resolved().size(); ++t) {
    const StageGaps gaps(ties, stage, t);
    const int particle = ties.resolved()[t].particle;
    at.positions[particle] = ties.mean(t, at.positions) + gaps.end;
    at.velocities[particle] = ties.mean(t, at.velocities) + (gaps.end - gaps.begin) / stage.a;
  }
}

/// Finds start_. The guess has been reached; the base of a method of several instants is a sum of
/// states, which may intersect itself.
void StageSolver::moveObstacles(const Cloth& cloth, const StageGuess& guess, StepReport& report) {
  if (!motion_) return;
  const SelfContact& contact = *cloth.selfContact();
  if (contact.obstacles() == nullptr) {
    start_ = guess.positions;
  } else {
    report.obstacle_cut =
        motion_->push(contact.nearPairs(), *contact.obstacles(), guess.positions, start_);
  }
}

/// Takes positions as far as they are reached without passing through, and velocities with them.
MotionCut StageSolver::keepApart(const Cloth& cloth, const Stage& stage, const Positions& from,
                                 ClothState& at) {
  if (!motion_) return {};
  const MotionCut cut =
      motion_->go(cloth.selfContact()->nearPairs(), cloth.selfContact()->obstacles(), from,
                  at.positions, at.positions);
  if (cut.particles == 0) return cut;
  for (int i = 0; i < matrix_.size(); ++i) {
    at.velocities[i] = (at.positions[i] - stage.base.positions[i]) / stage.a;
  }
  return cut;
}

/// What Newton iterations hold fixed. @param at near the end of the stage
void StageSolver::hold(const Cloth& cloth, const Stage& stage, const ClothState& at, bool passive) {
  ForceState state = forceState(stage, at.positions, at.velocities);
  if (stage.past.count > 0) state.past = &stage.past;
  cloth.forces().hold({stage.base.positions, state, stage.a, passive}, held_.data());
}

void StageSolver::linearise(const Cloth& cloth, const Stage& stage, const StageGuess& guess) {
  setInertia(cloth, stage.base, guess.velocities, pool_.get(), matrix_, rhs_);
  cloth.forces().assembleLinearised(forceState(stage, guess.positions, guess.velocities),
                                    {stage.a, guess.ahead}, matrix_, rhs_);
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
  for (const mesh::ResolvedTie& tie : cloth.ties().resolved()) {
    any_fixed_ = true;
    fixed_[tie.particle] = 1;
    prescribed_.col(tie.particle).setZero();
  }
}

void StageSolver::respond(const Cloth& cloth, const ClothState& at, double h,
                          std::vector<Vector3d>& ways) {
  linearise(cloth, {at, h, at.time, 1.0, {}}, {at.positions, at.velocities, 0.0});
  prescribed_.setZero();
  for (int i = 0; i < matrix_.size(); ++i) rhs_.col(i) = cloth.masses()[i] * ways[i];
  eliminate();
  response_.setZero();
  solver_.solve(matrix_, rhs_, settings_.tolerance, response_);
  for (int i = 0; i < matrix_.size(); ++i) {
    ways[i] = fixed_[i] ? Vector3d::Zero() : Vector3d(response_.col(i));
  }
}

void StageSolver::eliminate() {
  if (any_fixed_) matrix_.eliminate(fixed_, prescribed_, rhs_);
  if (touching()) contacts_->confine(matrix_, rhs_);
}

/// The linear solve of the linearised stage.
bool StageSolver::solveFirst(const Cloth& cloth, const Stage& stage, const StageGuess& guess,
                             StepReport& report) {
  if (contacts_) contacts_->begin(cloth, stage, guess.velocities, fixed_);
  if (!touching()) {
    eliminate();
    linearised_norm_ = rhs_.norm();
    return solveLinear(report);
  }
  const bool solved = solveTouching(guess.velocities, report);
  linearised_norm_ = round_norm_;
  return solved;
}

/// Solves matrix_ solution_ = rhs_, before anything is eliminated, under the conditions of the
/// contacts. @param velocities that the solution changes
bool StageSolver::solveTouching(const Velocities& velocities, StepReport& report,
                                linear::LinearSolver::Definiteness definiteness) {
  contacts_->beginSystem(velocities, matrix_, rhs_);
  bool solved = false;
  do {
    any_fixed_ = contacts_->prepareRound(matrix_, rhs_, fixed_, prescribed_);
    eliminate();
    round_norm_ = rhs_.norm();
    solved = solveLinear(report, definiteness);
    ++report.contact_rounds;
    if (!solved && definiteness == linear::LinearSolver::Definiteness::kUnknown) return false;
    if (contacts_->modes() > 0) moveBodies(definiteness, report);
    contacts_->compareLoads(solution_);
    while (contacts_->prepareLoads(rhs_)) {
      const Clock::time_point start = Clock::now();
      load_change_.setZero();
      report.linear_iterations +=
          solver_.solve(matrix_, rhs_, settings_.tolerance, load_change_, definiteness).iterations;
      contacts_->addLoads(load_change_, solution_);
      report.solve_seconds += seconds(Clock::now() - start);
    }
  } while (contacts_->update(solution_));
  return solved;
}

/// Lets the bodies that contacts hold to go with the solution of a round.
void StageSolver::moveBodies(linear::LinearSolver::Definiteness definiteness, StepReport& report) {
  const Clock::time_point start = Clock::now();
  for (int mode = 0; mode < contacts_->modes(); ++mode) {
    contacts_->prepareMode(mode, rhs_);
    load_change_.setZero();
    report.linear_iterations +=
        solver_.solve(matrix_, rhs_, settings_.tolerance, load_change_, definiteness).iterations;
    contacts_->setResponse(mode, load_change_);
  }
  contacts_->moveBodies(solution_);
  report.solve_seconds += seconds(Clock::now() - start);
}

/// Solves matrix_ solution_ = rhs_ from the guess in solution_; false if that did not converge.
bool StageSolver::solveLinear(StepReport& report, linear::LinearSolver::Definiteness definiteness) {
  const Clock::time_point start = Clock::now();
  for (int i = 0; any_fixed_ && i < matrix_.size(); ++i) {
    if (fixed_[i]) solution_.col(i).setZero();
  }
  if (touching()) contacts_->removeNormal(solution_);
  const linear::SolveResult result =
      solver_.solve(matrix_, rhs_, settings_.tolerance, solution_, definiteness);
  for (int i = 0; any_fixed_ && i < matrix_.size(); ++i) {
    if (fixed_[i]) solution_.col(i) = prescribed_.col(i);
  }
  if (touching()) contacts_->putNormal(solution_);
  report.solver = solver_.lastMethod();
  report.linear_iterations += result.iterations;
  report.linear_residual = result.residual;
  ++report.newton_iterations;
  report.solve_seconds += seconds(Clock::now() - start);
  return result.converged;
}

double StageSolver::incrementalPotential(const Cloth& cloth, const Stage& stage,
                                         const ClothState& at) const {
  double potential = cloth.forces().incrementalPotential(
      forceState(stage, at.positions, at.velocities), held_.data(), stage.a);
  for (int i = 0; i < matrix_.size(); ++i) {
    if (fixed_[i]) continue;
    const double mass = cloth.masses()[i];
    potential += 0.5 * mass * (at.velocities[i] - stage.base.velocities[i]).squaredNorm();
  }
  if (touching()) potential += contacts_->potential(at.velocities);
  return potential;
}

void StageSolver::assembleNewton(const Cloth& cloth, const Stage& stage, const ClothState& at,
                                 Hessian hessian, StepReport& report) {
  const Clock::time_point start = Clock::now();
  setInertia(cloth, stage.base, at.velocities, pool_.get(), matrix_, rhs_);
  cloth.forces().assembleNewton(forceState(stage, at.positions, at.velocities), held_.data(),
                                stage.a, hessian, matrix_, rhs_);
  if (!touching()) eliminate();
  report.assembly_seconds += seconds(Clock::now() - start);
}

}  // namespace haptex::cloth
