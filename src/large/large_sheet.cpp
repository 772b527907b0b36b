#include "haptex/large/large_sheet.h"

#include <petscsys.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/base/require.h"

namespace haptex::large {
namespace {

using cloth::ClothState;
using Eigen::Vector3d;

constexpr double kForceError = 1e-9;  // of the weight: the residual of a stage that has converged
constexpr int kMostSolves = 40;       // of a stage

int processes() {
  int count = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &count);
  return count;
}

int process() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

const Sheet& withRows(const Sheet& sheet, int parts) {
  if (sheet.rowCount() < parts) {
    base::refuse("the sheet has ", sheet.rowCount(), " rows of particles for ", parts,
                 " processes: each needs one");
  }
  return sheet;
}

}  // namespace

LargeSheet::LargeSheet(const Sheet& sheet)
    : sheet_(withRows(sheet, processes())),
      part_(process()),
      parts_(processes()),
      place_(placeOf(sheet, part_, parts_)),
      strip_(sheet, knownRows(sheet, part_, parts_)),
      matrix_(strip_.pattern()),
      rhs_(3, matrix_.size()),
      solution_(3, matrix_.size()),
      system_(matrix_, place_),
      trial_(strip_.state()) {
  if (part_ + 1 < parts_) {
    const Rows known = knownRows(sheet, part_, parts_);
    const Rows next = knownRows(sheet, part_ + 1, parts_);
    shared_.emplace(sheet, Rows{next.begin, known.end});
    shared_begin_ = (next.begin - known.begin) * sheet.rowSize();
    shared_trial_ = shared_->state();
  }
  double mass = 0.0;
  for (int i = place_.own_begin; i < place_.own_end; ++i) mass += strip_.cloth().masses()[i];
  weight_ = base::kStandardGravity * PetscSystem::sum(mass);
}

LargeStep LargeSheet::step(double time_step) {
  LargeStep step;
  step.converged = true;
  strip_.beginTrapezoid(time_step);
  system_.share(strip_.baseVelocities());
  if (shared_) {
    shared_->beginTrapezoid(time_step);
    std::copy_n(strip_.baseVelocities().begin() + shared_begin_, shared_->baseVelocities().size(),
                shared_->baseVelocities().begin());
  }
  solveStage(step);
  if (shared_) {
    copyShared(strip_.result(), shared_->result());
    shared_->beginBdf2();
  }
  strip_.beginBdf2();
  solveStage(step);
  if (shared_) {
    copyShared(strip_.result(), shared_->result());
    shared_->endStep();
  }
  strip_.endStep();
  return step;
}

/// From where earlier instants lead, or else from the linearised stage.
void LargeSheet::solveStage(LargeStep& step) {
  if (!strip_.predict()) {
    strip_.linearise(matrix_, rhs_);
    system_.take(matrix_, rhs_);
    if (!solve(step)) solution_.setZero();
    strip_.takeLinearised(solution_);
  }
  strip_.hold();
  if (shared_) {
    copyShared(strip_.result(), shared_->result());
    shared_->hold();
  }
  step.converged = iterateNewton(potentialOf(strip_.result()), step) && step.converged;
}

/// As cloth::StageSolver does. @param potential J, of the result
/// @returns whether it has converged, to kForceError or to rounding
bool LargeSheet::iterateNewton(double potential, LargeStep& step) {
  constexpr double kNear = 1e-5;   // of the weight: from where the exact Hessian is tried
  constexpr double kNearer = 0.1;  // of the residual where that was not positive definite
  constexpr double kSlow = 0.5;    // what of a residual is left if it still gets smaller
  double near = kNear;
  double unjudged = std::numeric_limits<double>::infinity();  // residual before such a change
  auto hessian = cloth::Hessian::kProjected;
  for (int solves = 0;; ++solves) {
    strip_.assembleNewton(hessian, matrix_, rhs_);
    system_.take(matrix_, rhs_);
    step.residual = system_.rhsNorm() / (strip_.a() * weight_);
    if (step.residual <= kForceError || step.residual > kSlow * unjudged) return true;
    if (solves == kMostSolves || !std::isfinite(step.residual)) return false;
    const bool exact = hessian == cloth::Hessian::kExact;
    const bool solved = solve(step);
    if (!solved && !exact) return false;
    const Descent descent = solved ? searchLine(potential) : Descent::kNone;
    if (descent == Descent::kBelowRounding) unjudged = step.residual;
    if (descent != Descent::kNone) {
      hessian = step.residual <= near ? cloth::Hessian::kExact : cloth::Hessian::kProjected;
    } else if (exact) {  // not positive definite here
      hessian = cloth::Hessian::kProjected;
      near = kNearer * step.residual;
    } else {
      return false;
    }
  }
}

/// The system that was taken last. @returns whether it converged
bool LargeSheet::solve(LargeStep& step) {
  const PetscSolve solve = system_.solve(solution_);
  ++step.newton_iterations;
  step.linear_iterations += solve.iterations;
  return solve.converged;
}

/// Moves the result along the solution to a lower potential, or to its end if the promised descent
/// is less than the rounding of the potential.
LargeSheet::Descent LargeSheet::searchLine(double& potential) {
  constexpr double kSufficientDecrease = 1e-4;
  constexpr double kRounding = 1e-12;
  constexpr int kMostHalvings = 40;
  const double descent = system_.product();
  const bool below_rounding = std::abs(descent) <= kRounding * std::abs(potential);
  if (!(descent > 0.0)) return below_rounding ? Descent::kBelowRounding : Descent::kNone;
  ClothState& result = strip_.result();
  double share = 1.0;
  for (int halving = 0; halving < kMostHalvings; ++halving, share *= 0.5) {
    for (int i = 0; i < matrix_.size(); ++i) {
      const Vector3d change = share * solution_.col(i);
      trial_.velocities[i] = result.velocities[i] + change;
      trial_.positions[i] = result.positions[i] + strip_.a() * change;
    }
    const double trial = potentialOf(trial_);
    if (trial <= potential - kSufficientDecrease * share * descent || below_rounding) {
      std::swap(result.positions, trial_.positions);
      std::swap(result.velocities, trial_.velocities);
      potential = trial;
      return below_rounding ? Descent::kBelowRounding : Descent::kFound;
    }
  }
  return Descent::kNone;
}

/// J, of the whole sheet: the incremental potential of the stage.
double LargeSheet::potentialOf(const ClothState& at) {
  double potential = strip_.potential(at);
  if (shared_) {
    copyShared(at, shared_trial_);
    potential -= shared_->potential(shared_trial_);
  }
  for (int i = place_.own_begin; i < place_.own_end; ++i) {
    if (strip_.isHeld(i)) continue;
    potential += 0.5 * strip_.cloth().masses()[i] *
                 (at.velocities[i] - strip_.baseVelocities()[i]).squaredNorm();
  }
  return PetscSystem::sum(potential);
}

/// Positions and velocities of the rows that the next process knows, too.
void LargeSheet::copyShared(const ClothState& from, ClothState& to) const {
  const auto size = static_cast<std::ptrdiff_t>(to.positions.size());
  std::copy_n(from.positions.begin() + shared_begin_, size, to.positions.begin());
  std::copy_n(from.velocities.begin() + shared_begin_, size, to.velocities.begin());
}

SheetEnergy LargeSheet::energy() const {
  const ClothState& state = strip_.state();
  SheetEnergy energy;
  for (int i = place_.own_begin; i < place_.own_end; ++i) {
    energy.kinetic += 0.5 * strip_.cloth().masses()[i] * state.velocities[i].squaredNorm();
  }
  energy.potential = strip_.cloth().potentialEnergy(state);
  if (shared_) energy.potential -= shared_->cloth().potentialEnergy(shared_->state());
  return {PetscSystem::sum(energy.kinetic), PetscSystem::sum(energy.potential)};
}

double LargeSheet::lowest() const {
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = place_.own_begin; i < place_.own_end; ++i) {
    lowest = std::min(lowest, strip_.state().positions[i].z());
  }
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_DOUBLE, MPI_MIN, PETSC_COMM_WORLD);
  return lowest;
}

}  // namespace haptex::large
