#include "haptex/simulation/simulated_cloth.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/scene/step_values.h"

namespace haptex::simulation {
namespace {

using base::refuse;

/// Of the substeps so far and the next one.
cloth::StepReport sum(const cloth::StepReport& first, cloth::StepReport last) {
  last.linear_converged = last.linear_converged && first.linear_converged;
  last.linear_iterations += first.linear_iterations;
  last.newton_iterations += first.newton_iterations;
  last.newton_converged = last.newton_converged && first.newton_converged;
  last.contact_rounds += first.contact_rounds;
  last.assembly_seconds += first.assembly_seconds;
  last.solve_seconds += first.solve_seconds;
  last.total_seconds += first.total_seconds;
  return last;
}

bool givesWayToLoads(const StepPlan& plan) {
  return cloth::isImplicit(plan.step.method) &&
         plan.step.method != cloth::IntegrationMethod::kBackwardEuler && !plan.adaptive;
}

}  // namespace

SimulatedCloth::SimulatedCloth(scene::Scene scene, material::Fabric fabric)
    : SimulatedCloth(std::move(scene), std::vector<material::Fabric>{std::move(fabric)}) {}

SimulatedCloth::SimulatedCloth(scene::Scene scene, std::vector<material::Fabric> fabrics)
    : SimulatedCloth(std::move(scene), std::move(fabrics),
                     {{scene.step, 1, 1, scene.adaptive_steps}}) {}

SimulatedCloth::SimulatedCloth(scene::Scene scene, material::Fabric fabric,
                               std::vector<StepPlan> plans)
    : SimulatedCloth(std::move(scene), std::vector<material::Fabric>{std::move(fabric)},
                     std::move(plans)) {}

SimulatedCloth::SimulatedCloth(scene::Scene scene, std::vector<material::Fabric> fabrics,
                               std::vector<StepPlan> plans)
    : cloth_(std::move(scene.mesh), std::move(fabrics), scene.effects),
      start_velocities_(std::move(scene.start_velocities)),
      start_time_(scene.start_time),
      state_(startState()),
      plans_(std::move(plans)),
      initially_attached_(std::move(scene.attached_particles)),
      frames_(std::move(scene.frames), cloth_.particleCount()),
      time_step_(scene.time_step),
      last_duration_(scene.time_step),
      disturbed_(scene.effects.contacts &&
                 std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                             [](const mesh::Obstacle& obstacle) { return obstacle.moves(); })),
      rest_(cloth_.particleCount()) {
  if (plans_.empty()) refuse("plans is empty: allowed is at least one plan");
  for (const StepPlan& plan : plans_) {
    if (plan.substeps < 1) refuse("substeps = ", plan.substeps, ": allowed are numbers >= 1");
    if (plan.cycles < 1 || (plan.cycles > 1 && plan.substeps > 1)) {
      refuse("cycles = ", plan.cycles, ": allowed are numbers >= 1, and 1 with several substeps");
    }
    if (plan.adaptive && (plan.substeps > 1 || plan.cycles > 1)) {
      refuse("a plan that is adaptive has ", plan.substeps, " substeps and ", plan.cycles,
             " cycles: allowed are 1 and 1");
    }
  }
  if (scene.effects.contacts) {
    collision_.emplace(cloth_, std::move(scene.obstacles), start_time_);
    start_bodies_ = collision_->bodies();
    if (scene.penalty) setPenalty(*scene.penalty);
  }
  attachInitially();
  makeIntegrators();
  requireFastened();
}

/// Of explicit steps alone: implicit ones keep their contacts exactly.
void SimulatedCloth::setPenalty(double stiffness) {
  for (const StepPlan& plan : plans_) {
    if (!cloth::isImplicit(plan.step.method)) continue;
    refuse("the scene has a penalty, which ", nameOf(plan.step.method),
           " does not know: allowed are explicit integrators");
  }
  collision_->setPenalty(stiffness);
}

const std::vector<contact::FreeBody>& SimulatedCloth::bodies() const {
  static const std::vector<contact::FreeBody> none;
  return collision_ ? collision_->bodies() : none;
}

bool SimulatedCloth::step() { return run(time_step_, 1, 0.0); }

bool SimulatedCloth::step(double duration) {
  requireDuration(duration);
  return run(duration, 1, 0.0);
}

void SimulatedCloth::requireDuration(double duration) {
  if (!(duration >= scene::kShortestTimeStep && duration <= scene::kLongestTimeStep)) {
    refuse("the step takes ", duration, " s: allowed are ", scene::kShortestTimeStep, " to ",
           scene::kLongestTimeStep, " s");
  }
}

bool SimulatedCloth::stepInRealTime(double waited) {
  const int cycles = asleep_ ? 1 : plans_[plan_].cycles;
  return run(cycles * time_step_, cycles, waited);
}

bool SimulatedCloth::run(double duration, int cycles, double waited) {
  last_duration_ = duration;
  opened_.clear();
  if (asleep_ && frames_.moves(cloth_, state_)) wake();
  if (asleep_) {
    state_.time += duration;
    ++steps_;
    return true;
  }
  frames_.beginStep(cloth_, state_, duration, excluded_);
  if (!controller_) {
    runSubsteps(duration);
  } else {
    const auto begin = std::chrono::steady_clock::now();
    runSubsteps(duration);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    plan_ = controller_->record(waited + took.count(), cycles);
  }
  last_step_rejected_ = !report_.accepted;
  if (!report_.accepted) {
    rest_.wake();
    return false;
  }
  ++steps_;
  ++computed_steps_;
  noteOpenedFasteners();
  sleepIfResting();
  return true;
}

void SimulatedCloth::sleepIfResting() {
  if (disturbed_) return;
  rest_.observe(state_);
  asleep_ = rest_.resting() && cloth::isUndisturbed(cloth_, state_.time);
  if (!asleep_) return;
  report_ = cloth::StepReport{};  // of the steps to come, which do nothing
  adaptive_report_ = AdaptiveReport{};
  report_.accepted = true;
}

void SimulatedCloth::wake() {
  rest_.wake();
  asleep_ = false;
}

void SimulatedCloth::runSubsteps(double duration) {
  adaptive_report_ = AdaptiveReport{};
  if (lengths_[plan_]) return runAdaptiveSubsteps(duration);
  const int substeps = plans_[plan_].substeps;
  if (substeps > 1) keep(before_);
  report_ = runSubstep(duration / substeps);
  for (int i = 1; i < substeps && report_.accepted; ++i) {
    report_ = sum(report_, runSubstep(duration / substeps));
  }
  if (substeps > 1 && !report_.accepted) bringBack(before_);
}

void SimulatedCloth::keep(Snapshot& snapshot) const {
  snapshot.state = state_;
  if (!start_bodies_.empty()) snapshot.bodies = collision_->bodies();
}

void SimulatedCloth::bringBack(const Snapshot& snapshot) {
  state_ = snapshot.state;
  if (!start_bodies_.empty()) collision_->setBodies(snapshot.bodies);
}

/// A step that is not finite, as one that misses the error, is repeated in shorter ones.
void SimulatedCloth::runAdaptiveSubsteps(double duration) {
  cloth::StepLengthControl& lengths = *lengths_[plan_];
  keep(before_);
  cloth::StepReport total;
  double left = duration;
  while (left > 0.0) {
    const double length = lengths.lengthWithin(left);
    keep(before_substep_);
    cloth::StepReport report = runSubstep(length);
    const bool again = report.accepted ? !lengths.judge(cloth_, before_substep_.state, state_, left)
                                       : lengths.shorten(left);
    if (again) report.linear_converged = report.newton_converged = true;  // of those taken
    total = sum(total, report);
    if (again) {
      bringBack(before_substep_);
      ++adaptive_report_.repeated;
      continue;
    }
    if (!report.accepted) {
      bringBack(before_);
      break;
    }
    left = length < left ? left - length : 0.0;
    const int taken = adaptive_report_.substeps++;
    adaptive_report_.shortest = taken == 0 ? length : std::min(adaptive_report_.shortest, length);
    adaptive_report_.error = std::max(adaptive_report_.error, lengths.error());
    adaptive_report_.missed = adaptive_report_.missed || lengths.missed();
  }
  report_ = total;
}

cloth::StepReport SimulatedCloth::runSubstep(double duration) {
  cloth::Integrator& integrator =
      loaded_ && loaded_ones_[plan_] ? *loaded_ones_[plan_] : integrators_[plan_];
  cloth::ClothState& state = part_ ? part_->begin(cloth_, state_) : state_;
  const cloth::StepReport report = collision_
                                       ? collision_->step(computed(), integrator, state, duration)
                                       : integrator.step(computed(), state, duration);
  if (part_ && report.accepted) part_->end(state_);
  return report;
}

void SimulatedCloth::use(std::size_t plan) {
  if (plan >= plans_.size()) {
    refuse("plan = ", plan, ": allowed are 0 to ", plans_.size() - 1);
  }
  plan_ = plan;
}

void SimulatedCloth::setController(QualityController controller) {
  if (controller.size() != plans_.size()) {
    refuse("the controller chooses among ", controller.size(), " qualities: allowed are ",
           plans_.size(), ", one per plan");
  }
  controller_.emplace(std::move(controller));
  plan_ = controller_->running();
}

void SimulatedCloth::relieve() {
  if (!controller_) return;
  controller_->relieve();
  plan_ = controller_->running();
}

void SimulatedCloth::reset() {
  excluded_.clear();
  part_.reset();
  cloth_.releaseAll();
  cloth_.setPointLoads({});
  loaded_ = false;
  for (int i = 0; pushed_ && i < static_cast<int>(cloth_.particleCount()); ++i) {
    cloth_.setExternalForce(i, Eigen::Vector3d::Zero());
  }
  pushed_ = false;
  attachInitially();
  frames_.reset();
  state_ = startState();
  if (!start_bodies_.empty()) collision_->setBodies(start_bodies_);
  makeIntegrators();  // the old ones remember their last solutions and factors
  report_ = cloth::StepReport{};
  adaptive_report_ = AdaptiveReport{};
  last_step_rejected_ = false;
  steps_ = 0;
  readFastened();
  opened_.clear();
  wake();
}

cloth::ClothState SimulatedCloth::startState() const {
  cloth::ClothState state = cloth_.initialState();
  if (!start_velocities_.empty()) state.velocities = start_velocities_;
  state.time = start_time_;
  return state;
}

void SimulatedCloth::makeIntegrators() {
  integrators_.clear();
  loaded_ones_.clear();
  lengths_.clear();
  bool several = false, adaptive = false;
  for (const StepPlan& plan : plans_) {
    integrators_.emplace_back(computed(), plan.step);
    loaded_ones_.emplace_back();
    if (cloth_.effects().point_loads && givesWayToLoads(plan)) {
      cloth::StepSettings step = plan.step;
      step.method = cloth::IntegrationMethod::kBackwardEuler;
      loaded_ones_.back().emplace(computed(), step);
    }
    lengths_.emplace_back();
    if (plan.adaptive) lengths_.back().emplace(cloth_, plan.step.method, *plan.adaptive);
    several = several || plan.substeps > 1 || plan.adaptive;
    adaptive = adaptive || plan.adaptive;
  }
  if (several) keep(before_);
  if (adaptive) keep(before_substep_);
}

void SimulatedCloth::attachInitially() {
  for (const int particle : initially_attached_) {
    cloth_.attach(particle,
                  {cloth_.mesh().initial_positions[particle], Eigen::Vector3d::Zero(), 0, 0});
  }
}

}  // namespace haptex::simulation
