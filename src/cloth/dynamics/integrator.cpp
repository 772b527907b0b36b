#include "haptex/cloth/dynamics/integrator.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace haptex::cloth {
namespace {

using Clock = std::chrono::steady_clock;
using Eigen::Vector3d;

constexpr double kMaxStepGrowth = 2.0;  // of BDF-2 from step to step

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
  if (settings.newton_error != 0.0) requireFraction("newton_error", settings.newton_error);
  if (settings.newton_iterations < 1) {
    std::ostringstream message;
    message << "newton_iterations is " << settings.newton_iterations << "; it must be at least 1";
    throw std::invalid_argument(message.str());
  }
  if (settings.threads < 1 || settings.threads > kMaxThreads) {
    std::ostringstream message;
    message << "threads is " << settings.threads << "; it must lie from 1 to " << kMaxThreads;
    throw std::invalid_argument(message.str());
  }
  return settings;
}

void requireSelfCollision(const Cloth& cloth, IntegrationMethod method) {
  const ModelledEffects& effects = cloth.effects();
  if (!effects.self_collision || collidesWithItself(method, effects.contacts)) return;
  throw std::invalid_argument(std::string("self_collision is modelled") +
                              (effects.contacts ? " with obstacles" : "") +
                              ", which the integrator " + nameOf(method) + " does not know");
}

void requireBodies(const Cloth& cloth, IntegrationMethod method) {
  if (cloth.bodies().bodies.empty() || knowsBodies(method)) return;
  throw std::invalid_argument(std::string("there are obstacles with mass, which the integrator ") +
                              nameOf(method) +
                              " does not know; allowed are backward_euler and explicit ones");
}

/// m/s, of the free particles' centre of mass. @param mass kg, theirs
Vector3d meanVelocity(const Cloth& cloth, const Velocities& velocities, double& mass) {
  Vector3d momentum = Vector3d::Zero();
  mass = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    momentum += cloth.masses()[i] * velocities[i];
    mass += cloth.masses()[i];
  }
  return mass > 0.0 ? Vector3d(momentum / mass) : momentum;
}

bool allFinite(const std::vector<Vector3d>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const Vector3d& vector) { return vector.allFinite(); });
}

}  // namespace

Integrator::Integrator(const Cloth& cloth, const StepSettings& settings)
    : settings_(requireSound(settings)),
      pattern_size_(cloth.patternSize()),
      held_size_(cloth.forces().heldSize()),
      bodies_(cloth.bodies().bodies.size()),
      end_(cloth.initialState()) {
  const IntegrationMethod method = settings.method;
  requireSelfCollision(cloth, method);
  requireBodies(cloth, method);
  if (!isImplicit(method)) {
    explicit_step_.emplace(cloth, method);
    return;
  }
  stages_.emplace(cloth, settings);
  const bool two_instants =
      method == IntegrationMethod::kBdf2 || method == IntegrationMethod::kTrBdf2;
  if (two_instants && settings.newton_iterations > 1 && (cloth.effects().viscosity || predicts())) {
    motion_.emplace(cloth);
  }
  balance_.emplace(cloth, motion_.has_value(), stages_->pool());
  if (cloth.selfContact() != nullptr) untangling_.emplace(cloth);
  if (method == IntegrationMethod::kBackwardEuler) return;
  if (method == IntegrationMethod::kBackwardMidpoint) forces_.resize(cloth.particleCount());
  if (two_instants) base_ = end_;
  if (method == IntegrationMethod::kBdf2) history_ = History{end_, end_};
}

StepReport Integrator::step(const Cloth& cloth, ClothState& state, double time_step) {
  if (!std::isfinite(time_step) || time_step <= 0.0) {
    std::ostringstream message;
    message << "the time step is " << time_step << " s; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
  if (state.positions.size() != cloth.particleCount() ||
      state.velocities.size() != cloth.particleCount() ||
      end_.positions.size() != cloth.particleCount() || cloth.patternSize() != pattern_size_ ||
      cloth.forces().heldSize() != held_size_ || cloth.bodies().bodies.size() != bodies_ ||
      state.memory.size() != cloth.forces().memorySize() ||
      end_.memory.size() != cloth.forces().memorySize()) {
    throw std::invalid_argument("the state, the cloth and the integrator differ in size");
  }
  StepReport report;
  const Clock::time_point start = Clock::now();
  end_.time = state.time + time_step;
  end_.memory = state.memory;  // until the step is accepted
  if (untangling_) untangling_->begin(cloth, state, time_step);
  advance(cloth, state, time_step, report);
  settle(end_.velocities);
  if (balance_) keepEnergy(cloth, state, time_step, report);
  followTies(cloth);
  report.accepted = std::isfinite(report.linear_residual) && std::isfinite(end_.time) &&
                    allFinite(end_.positions) && allFinite(end_.velocities);
  if (report.accepted) {
    const bool is_other =
        untangling_ && untangling_->end(cloth, time_step, *stages_, end_, report.tangle);
    cloth.remember(end_);
    if (motion_ && report.taken_anew) motion_->startAnew(end_);
    if (motion_) motion_->end(end_);
    keep(cloth, state, time_step, touches() || report.taken_anew, report.energy_taken);
    if (is_other) balance_->forgetPotential();
  } else if (stages_) {
    stages_->forget();
    if (motion_) motion_->forget();
  }
  report.total_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return report;
}

/// At the end of the step, what changes velocities or attached particles does not know of ties.
void Integrator::followTies(const Cloth& cloth) {
  cloth.ties().place(end_.time, end_.positions);
  cloth.ties().carry(end_.time, end_.velocities);
}

void Integrator::keepEnergy(const Cloth& cloth, const ClothState& begin, double h,
                            StepReport& report) {
  // Of the kinetic energy. It doubles with every solve of a step taken anew but the first, up to
  // all that can be taken: what the next solve would still save is worth less and less.
  double most_taken = 0.1;
  balance_->begin(cloth, begin);
  double gained = 0.0;
  const auto is_small = [&] {
    gained = balance_->excess(cloth, begin, end_, contactReactions());
    return gained <= 0.0 || gained <= most_taken * balance_->kineticAtEnd();
  };
  int solves = 0;
  const auto is_small_enough = [&] {
    const bool small = is_small();
    if (report.newton_iterations > solves) most_taken = std::min(1.0, 2.0 * most_taken);
    return small;
  };
  if (!is_small()) {
    report.taken_anew = true;
    const Stage stage{begin, h, end_.time, 1.0, StrainPast::since(begin.positions, h)};
    if (settings_.method != IntegrationMethod::kBackwardEuler) {
      stages_->forget();
      stages_->beginAnew(cloth, stage, {begin.positions, begin.velocities, h}, end_, report);
    }
    solves = report.newton_iterations;
    const bool judged = stages_->descend(cloth, stage, std::ref(is_small_enough), end_, report);
    stages_->forget();
    settle(end_.velocities);
    if (!judged || touches()) is_small();
  }
  if (gained > 0.0) slowDown(cloth, gained, report);
}

/// Takes energy (J) out of the velocities at the end, as far as there is any. With bodies, whose
/// momentum and the cloth's stay together, only the motion beside the mean is slowed down.
void Integrator::slowDown(const Cloth& cloth, double energy, StepReport& report) {
  double kinetic = balance_->kineticAtEnd();
  Vector3d mean = Vector3d::Zero();
  if (bodies_ > 0) {
    double mass = 0.0;
    mean = meanVelocity(cloth, end_.velocities, mass);
    kinetic -= 0.5 * mass * mean.squaredNorm();
  }
  if (!(kinetic > 0.0)) return;
  report.energy_taken = std::min(energy, kinetic);
  const double factor = std::sqrt(1.0 - report.energy_taken / kinetic);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    end_.velocities[i] = mean + factor * (end_.velocities[i] - mean);  // without bodies it is 0
  }
  settle(end_.velocities);
}

void Integrator::advance(const Cloth& cloth, const ClothState& begin, double h,
                         StepReport& report) {
  if (explicit_step_) return explicit_step_->advance(cloth, begin, h, end_);
  switch (settings_.method) {
    case IntegrationMethod::kBackwardMidpoint:
      return runMidpoint(cloth, begin, h, report);
    case IntegrationMethod::kTrBdf2:
      return runTrBdf2(cloth, begin, h, report);
    case IntegrationMethod::kBdf2:
      if (!continuesHistory(begin, h)) return runTrBdf2(cloth, begin, h, report);
      base_.memory = begin.memory;
      return runBdf2(cloth, history_->before, begin, history_->time_step, h, report);
    default:
      return stages_->solve(cloth,
                            {begin, h, end_.time, 1.0, StrainPast::since(begin.positions, h)},
                            {begin.positions, begin.velocities, h}, end_, report);
  }
}

/// Takes the state over from end_. @param anew the next step of BDF-2 is to start anew
void Integrator::keep(const Cloth& cloth, ClothState& state, double h, bool anew,
                      double energy_taken) {
  if (balance_) balance_->keep(cloth, end_, energy_taken);
  if (history_) std::swap(history_->before, state);
  std::swap(state.positions, end_.positions);
  std::swap(state.velocities, end_.velocities);
  std::swap(state.memory, end_.memory);
  state.time = end_.time;
  if (!history_) return;
  history_->last = state;
  history_->time_step = anew ? 0.0 : h;
}

bool Integrator::touches() const {
  return stages_ && stages_->contacts() && stages_->contacts()->holding();
}

/// Bodies touch each other, too, when the cloth does not.
void Integrator::settle(Velocities& velocities) {
  if (touches() || (stages_ && bodies_ > 0)) stages_->contacts()->settle(velocities);
}

const std::vector<BodyMotion>& Integrator::bodyMotions() {
  static const std::vector<BodyMotion> none;
  return stages_ && stages_->contacts() ? stages_->contacts()->bodyMotions() : none;
}

const std::vector<ContactReaction>& Integrator::contactReactions() const {
  static const std::vector<ContactReaction> none;
  return stages_ && stages_->contacts() ? stages_->contacts()->reactions() : none;
}

bool Integrator::continuesHistory(const ClothState& begin, double h) const {
  return history_->time_step > 0.0 && h <= kMaxStepGrowth * history_->time_step &&
         begin.time == history_->last.time && begin.positions == history_->last.positions &&
         begin.velocities == history_->last.velocities;
}

/// A stage at theta = 1/2 + blend of the step, and on from there in a straight line:
///   x1 = x0 + (x - x0) / theta,  v1 = v0 + (v - v0) / theta.
/// For linear forces the energy then changes by what attachments and wind do minus
///   blend (|v1 - v0|_M^2 + |x1 - x0|_K^2),
/// so the first term tells how much blend takes away what nonlinear forces have added; where that
/// does not suffice it is doubled. What they add at the midpoint is of the third order in h, so
/// the blend is of the first, and the step still of the second order.
void Integrator::runMidpoint(const Cloth& cloth, const ClothState& begin, double h,
                             StepReport& report) {
  constexpr double kMaxBlend = 0.5;
  const double potential = cloth.potentialEnergy(begin, stages_->pool());
  while (true) {
    const double theta = 0.5 + report.blend;
    stages_->solve(cloth, {begin, theta * h, end_.time, theta, {}},
                   {begin.positions, begin.velocities, theta * h}, end_, report);
    const double work = outerWork(cloth, begin, h, theta);
    extrapolate(cloth, begin, theta);
    if (report.blend >= kMaxBlend) return;
    const double enough = blendAgainstGrowth(cloth, begin, potential + work);
    if (!(enough > 0.0)) return;
    report.blend = std::min(kMaxBlend, std::max(2.0 * report.blend, report.blend + enough));
  }
}

/// @param allowed potential energy (J) at the end, if the velocities stay as they are
/// @return 0 if the step to end_ has not gained energy beyond what solves and rounding leave open
double Integrator::blendAgainstGrowth(const Cloth& cloth, const ClothState& begin,
                                      double allowed) const {
  constexpr double kRounding = 1e-13;
  const double potential = cloth.potentialEnergy(end_, stages_->pool());
  double growth = potential - allowed;
  double kinetic = 0.0, change_squared = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    const double mass = cloth.masses()[i];
    const Vector3d change = end_.velocities[i] - begin.velocities[i];
    const Vector3d sum = end_.velocities[i] + begin.velocities[i];
    growth += 0.5 * mass * change.dot(sum);
    kinetic += 0.5 * mass * sum.squaredNorm();
    change_squared += mass * change.squaredNorm();
  }
  const double open = settings_.tolerance * change_squared +
                      kRounding * (kinetic + std::abs(potential) + std::abs(allowed));
  return growth > open ? growth / change_squared : 0.0;
}

/// What attachments and driven forces do over the step (J) by the forces in the stage at theta that
/// end_ holds. What the air takes from motion relative to it is not work that may come back.
double Integrator::outerWork(const Cloth& cloth, const ClothState& begin, double h, double theta) {
  const double end = end_.time;
  end_.time = begin.time + theta * h;
  double work = h * cloth.forces().drivingPower(end_.ofForces());
  bool known = false;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    if (!attachment) continue;
    const Vector3d way = attachment->position(end) - begin.positions[i];
    if (way.isZero(0.0)) continue;
    if (!known) cloth.computeForces(end_, forces_);
    known = true;
    work -= forces_[i].dot(way);
  }
  end_.time = end;
  return work;
}

void Integrator::extrapolate(const Cloth& cloth, const ClothState& begin, double theta) {
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (const auto& attachment = cloth.attachments()[i]) {
      end_.positions[i] = attachment->position(end_.time);
      end_.velocities[i] = attachment->velocity(end_.time);
      continue;
    }
    end_.positions[i] = begin.positions[i] + (end_.positions[i] - begin.positions[i]) / theta;
    end_.velocities[i] = begin.velocities[i] + (end_.velocities[i] - begin.velocities[i]) / theta;
  }
  followTies(cloth);
}

/// The trapezoidal rule over gamma h, then BDF-2 over its beginning and end; with
/// gamma = 2 - sqrt 2 both stages have the same a (Bank et al. 1985).
void Integrator::runTrBdf2(const Cloth& cloth, const ClothState& begin, double h,
                           StepReport& report) {
  const double first = trapezoidPart(h);
  base_.memory = begin.memory;
  const StageStart start =
      startTrapezoid(cloth, begin, first, motion_ ? &*motion_ : nullptr, base_);
  const Positions* predicted =
      start.goes_on && predicts() ? motion_->predictAfter(begin, first) : nullptr;
  stages_->solve(cloth, {base_, start.a, begin.time + first, 1.0, start.past},
                 {begin.positions, begin.velocities, first, predicted}, end_, report);
  settle(end_.velocities);
  runBdf2(cloth, begin, end_, first, h - first, report);
}

/// From `before` by `first` seconds to `middle`, which may be end_, and by `second` to the end. The
/// velocities of the guess are the mean ones between `before` and `middle`.
void Integrator::runBdf2(const Cloth& cloth, const ClothState& before, const ClothState& middle,
                         double first, double second, StepReport& report) {
  const StageStart start = startBdf2(before, middle, first, second, motion_ ? &*motion_ : nullptr,
                                     base_, end_.velocities);
  // A velocity from before an impact would make what touches rebound.
  settle(base_.velocities);
  const Positions* predicted = start.goes_on && predicts()
                                   ? motion_->predict(before, middle.positions, first, second)
                                   : nullptr;
  stages_->solve(cloth, {base_, start.a, end_.time, 1.0, start.past},
                 {middle.positions, end_.velocities, second, predicted}, end_, report);
}

}  // namespace haptex::cloth
