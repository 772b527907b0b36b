#include "haptex/cloth/backward_euler.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::cloth {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

void requireFraction(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0 || value >= 1.0) {
    std::ostringstream message;
    message << name << " is " << value << "; it must lie between 0 and 1, both excluded";
    throw std::invalid_argument(message.str());
  }
}

const StepSettings& requireSound(const StepSettings& settings) {
  requireFraction("tolerance", settings.tolerance);
  requireFraction("newton_tolerance", settings.newton_tolerance);
  if (settings.newton_iterations < 1) {
    std::ostringstream message;
    message << "newton_iterations is " << settings.newton_iterations << "; it must be at least 1";
    throw std::invalid_argument(message.str());
  }
  return settings;
}

bool allFinite(const std::vector<Eigen::Vector3d>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const Eigen::Vector3d& vector) { return vector.allFinite(); });
}

std::size_t couplingCount(const Cloth& cloth) {
  return cloth.bending() ? cloth.bending()->couplings().size() : 0;
}

}  // namespace

BackwardEuler::BackwardEuler(const Cloth& cloth, const StepSettings& settings)
    : settings_(requireSound(settings)),
      element_count_(cloth.membrane().elements().size()),
      coupling_count_(couplingCount(cloth)),
      matrix_(cloth.pattern()),
      solver_(matrix_, settings.solver),
      rhs_(3, cloth.particleCount()),
      solution_(BlockVector::Zero(3, cloth.particleCount())),
      prescribed_(BlockVector::Zero(3, cloth.particleCount())),
      fixed_(cloth.particleCount(), 0),
      end_(cloth.initialState()) {
  if (settings.newton_iterations > 1) {
    trial_ = end_;
    begin_strains_.resize(cloth.membrane().elements().size());
  }
}

StepReport BackwardEuler::step(const Cloth& cloth, ClothState& state, double time_step) {
  if (!std::isfinite(time_step) || time_step <= 0.0) {
    std::ostringstream message;
    message << "the time step is " << time_step << " s; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
  if (state.positions.size() != cloth.particleCount() ||
      state.velocities.size() != cloth.particleCount() || fixed_.size() != cloth.particleCount() ||
      cloth.membrane().elements().size() != element_count_ ||
      couplingCount(cloth) != coupling_count_) {
    throw std::invalid_argument("the state, the cloth and the integrator differ in size");
  }
  StepReport report;
  const Clock::time_point start = Clock::now();
  matrix_.setZero();
  const std::vector<double>& masses = cloth.masses();
  for (int i = 0; i < matrix_.size(); ++i) {
    matrix_.diagonal(i).diagonal().setConstant(masses[i]);
    rhs_.col(i) = time_step * (cloth.externalForces()[i] + masses[i] * cloth.effects().gravity);
  }
  cloth.membrane().addStep(state.positions, state.velocities, time_step, matrix_, rhs_);
  if (cloth.bending()) {
    cloth.bending()->addStep(state.positions, state.velocities, time_step, matrix_, rhs_);
  }
  addPointLoadStep(cloth.pointLoads(), cloth.mesh().triangles, cloth.membrane().elements(),
                   state.positions, state.velocities, time_step, time_step, matrix_, rhs_);
  prescribe(cloth, state, time_step);
  report.assembly_seconds = seconds(Clock::now() - start);

  report.linear_converged = solveLinear(report);
  end_.time = state.time + time_step;
  for (int i = 0; i < matrix_.size(); ++i) {
    end_.velocities[i] = state.velocities[i] + solution_.col(i);
    end_.positions[i] = fixed_[i] ? cloth.attachments()[i]->position(end_.time)
                                  : state.positions[i] + time_step * end_.velocities[i];
  }
  if (settings_.newton_iterations > 1) iterateNewton(cloth, state, time_step, report);

  report.accepted = std::isfinite(report.linear_residual) && std::isfinite(end_.time) &&
                    allFinite(end_.positions) && allFinite(end_.velocities);
  if (report.accepted) {
    std::swap(state.positions, end_.positions);
    std::swap(state.velocities, end_.velocities);
    state.time = end_.time;
  } else {
    solution_.setZero();  // no initial guess for the next step
  }
  report.total_seconds = seconds(Clock::now() - start);
  return report;
}

void BackwardEuler::prescribe(const Cloth& cloth, const ClothState& state, double time_step) {
  any_fixed_ = false;
  for (int i = 0; i < matrix_.size(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    fixed_[i] = attachment.has_value();
    if (!attachment) continue;
    any_fixed_ = true;
    const Eigen::Vector3d place = attachment->position(state.time + time_step);
    prescribed_.col(i) = (place - state.positions[i]) / time_step - state.velocities[i];
  }
  if (any_fixed_) matrix_.eliminate(fixed_, prescribed_, rhs_);
}

/// Solves matrix_ solution_ = rhs_ from the guess in solution_; false if that did not converge.
bool BackwardEuler::solveLinear(StepReport& report) {
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

double BackwardEuler::incrementalPotential(const Cloth& cloth, const ClothState& begin, double h,
                                           const Positions& positions,
                                           const Velocities& velocities) const {
  double potential = cloth.membrane().incrementalPotential(positions, begin_strains_, h) +
                     pointLoadEnergy(cloth.pointLoads(), cloth.mesh().triangles, positions);
  if (cloth.bending()) potential += cloth.bending()->energy(positions);
  for (int i = 0; i < matrix_.size(); ++i) {
    if (fixed_[i]) continue;
    const double mass = cloth.masses()[i];
    potential += 0.5 * mass * (velocities[i] - begin.velocities[i]).squaredNorm();
    potential -= (cloth.externalForces()[i] + mass * cloth.effects().gravity)
                     .dot(positions[i] - begin.positions[i]);
  }
  return potential;
}

void BackwardEuler::assembleNewton(const Cloth& cloth, const ClothState& begin, double h,
                                   Membrane::Hessian hessian, StepReport& report) {
  const Clock::time_point start = Clock::now();
  matrix_.setZero();
  for (int i = 0; i < matrix_.size(); ++i) {
    const double mass = cloth.masses()[i];
    matrix_.diagonal(i).diagonal().setConstant(mass);
    rhs_.col(i) = h * (cloth.externalForces()[i] + mass * cloth.effects().gravity) -
                  mass * (end_.velocities[i] - begin.velocities[i]);
  }
  cloth.membrane().addNewton(end_.positions, begin_strains_, h, hessian, matrix_, rhs_);
  if (cloth.bending()) cloth.bending()->addNewton(end_.positions, h, matrix_, rhs_);
  addPointLoadStep(cloth.pointLoads(), cloth.mesh().triangles, cloth.membrane().elements(),
                   end_.positions, end_.velocities, h, 0.0, matrix_, rhs_);
  if (any_fixed_) matrix_.eliminate(fixed_, prescribed_, rhs_);
  report.assembly_seconds += seconds(Clock::now() - start);
}

void BackwardEuler::iterateNewton(const Cloth& cloth, const ClothState& begin, double h,
                                  StepReport& report) {
  constexpr double kNearMinimum = 1e-2;  // relative residual from which the exact Hessian is tried
  const double reference = rhs_.norm();
  cloth.membrane().computeStrains(begin.positions, begin_strains_);
  double potential = incrementalPotential(cloth, begin, h, end_.positions, end_.velocities);
  prescribed_.setZero();  // the attached particles have reached their places
  auto hessian = Membrane::Hessian::kProjected;
  while (true) {
    assembleNewton(cloth, begin, h, hessian, report);
    const double norm = rhs_.norm();
    report.newton_residual = reference > 0.0 ? norm / reference : norm;
    report.newton_converged = norm <= settings_.newton_tolerance * reference;
    if (report.newton_converged || report.newton_iterations >= settings_.newton_iterations) return;
    solution_.setZero();
    const bool solved = solveLinear(report);
    const bool exact = hessian == Membrane::Hessian::kExact;
    if (!exact) report.linear_converged = report.linear_converged && solved;
    const Descent descent = solved ? searchLine(cloth, begin, h, potential) : Descent::kNone;
    if (descent == Descent::kFound) {
      hessian = norm <= kNearMinimum * reference ? Membrane::Hessian::kExact
                                                 : Membrane::Hessian::kProjected;
    } else if (descent == Descent::kNone && exact) {  // not positive definite here
      hessian = Membrane::Hessian::kProjected;
    } else {
      report.newton_converged = descent == Descent::kBelowRounding;
      return;
    }
  }
}

/// Moves end_ along solution_ to a lower potential.
BackwardEuler::Descent BackwardEuler::searchLine(const Cloth& cloth, const ClothState& begin,
                                                 double h, double& potential) {
  constexpr double kSufficientDecrease = 1e-4;
  constexpr double kRounding = 1e-14;
  constexpr int kMostHalvings = 40;
  const double descent = rhs_.cwiseProduct(solution_).sum();
  const bool below_rounding = std::abs(descent) <= kRounding * std::abs(potential);
  if (!(descent > 0.0)) return below_rounding ? Descent::kBelowRounding : Descent::kNone;
  double step = 1.0;
  for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
    for (int i = 0; i < matrix_.size(); ++i) {
      const Eigen::Vector3d change = step * solution_.col(i);
      trial_.velocities[i] = end_.velocities[i] + change;
      trial_.positions[i] = end_.positions[i] + h * change;
    }
    const double trial = incrementalPotential(cloth, begin, h, trial_.positions, trial_.velocities);
    if (trial <= potential - kSufficientDecrease * step * descent || below_rounding) {
      std::swap(end_.positions, trial_.positions);
      std::swap(end_.velocities, trial_.velocities);
      potential = trial;
      return below_rounding ? Descent::kBelowRounding : Descent::kFound;
    }
  }
  return Descent::kNone;
}

}  // namespace haptex::cloth
