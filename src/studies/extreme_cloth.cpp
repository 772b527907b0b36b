#include "haptex/studies/extreme_cloth.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "haptex/base/constants.h"
#include "haptex/base/quantity.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/studies/extreme_outcome.h"

namespace haptex::studies {
namespace {

constexpr double kFirstStep = 0.01;    // s
constexpr double kLongestStep = 30.0;  // s
constexpr double kStepGrowth = 1.3;    // from step to step
constexpr int kMaxSteps = 400;
constexpr double kNewtonTolerance = 1e-12;  // of steps that are solved to the end

double largestSpeed(const cloth::ClothState& state) {
  double largest = 0.0;
  for (const Eigen::Vector3d& velocity : state.velocities) {
    largest = base::largerOrNaN(largest, velocity.norm());
  }
  return largest;
}

double extentOf(const cloth::ClothState& state) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& position : state.positions) box.extend(position);
  return box.sizes().maxCoeff();
}

/// About that of a pendulum as long as the cloth, or of a string under the tension of a taut sheet;
/// or the time in which viscosity lets strains decay.
double slowestPeriod(const ExtremeCase& extreme, double extent) {
  const double decay = 2.0 * M_PI * extreme.viscosity;
  if (!extreme.taut)
    return std::max(decay, 2.0 * M_PI * std::sqrt(extent / base::kStandardGravity));
  const double tension = std::min(extreme.weft, extreme.warp) * extreme.strain;
  return std::max(decay, 2.0 * extent * std::sqrt(extreme.density / tension));
}

/// Largest force on a free particle over the largest on an attached one.
double unbalancedOf(const cloth::Cloth& cloth, const std::vector<Eigen::Vector3d>& forces) {
  double held = 0.0, free = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    double& largest = cloth.attachments()[i] ? held : free;
    largest = base::largerOrNaN(largest, forces[i].norm());
  }
  return free / held;
}

/// The same of groups of particles, free or attached, within the tolerance of each other: what acts
/// within a group, a needle mostly, decides about places to about the tolerance.
double unbalancedOf(const cloth::Cloth& cloth, const cloth::ClothState& state, double extent) {
  std::vector<Eigen::Vector3d> forces;
  cloth.computeForces(state, forces);
  const double single = unbalancedOf(cloth, forces);
  if (single <= 0.1 * kBalanced) return single;
  std::vector<std::size_t> next(forces.size());  // in the group, or the particle that stands for it
  std::iota(next.begin(), next.end(), 0);
  const auto group_of = [&](std::size_t i) {
    while (next[i] != i) i = next[i];
    return i;
  };
  for (std::size_t i = 0; i < forces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = (state.positions[i] - state.positions[j]).norm();
      if (apart > kReturnTolerance * extent || cloth.isAttached(i) != cloth.isAttached(j)) continue;
      const std::size_t group = group_of(i), other = group_of(j);
      if (group == other) continue;
      next[other] = group;
      forces[group] += forces[other];
      forces[other].setZero();
    }
  }
  return unbalancedOf(cloth, forces);
}

cloth::StepSettings settingsOf(const ExtremeCase& extreme) {
  cloth::StepSettings settings;
  settings.newton_iterations = extreme.newton_iterations;
  return settings;
}

/// Steps until the cloth is at rest; false if it is not after most_steps, or does not move any
/// more.
bool settleBy(const cloth::StepSettings& settings, int most_steps, double period,
              const cloth::Cloth& cloth, const cloth::ClothState& rest,
              IntersectionWatch& intersections, cloth::ClothState& state, Settling& settling) {
  constexpr double kStepsPerPeriod = 6.0;
  constexpr int kStillSteps = 300;
  cloth::Integrator integrator(cloth, settings);
  const double slow = kReturnTolerance * extentOf(rest) / period;  // m/s
  double time_step = std::min(kFirstStep, period / kStepsPerPeriod);
  int still = 0;
  EnergyWatch watch(intersections.isTangled() ? kUnwatchedTangled : 0);
  for (int i = 0; i < most_steps; ++i) {
    const cloth::ClothState before = state;
    watch.begin(cloth, before);
    const cloth::StepReport report = integrator.step(cloth, state, time_step);
    if (!report.accepted) ++settling.rejected;
    ++settling.steps;
    settling.growth = base::largerOrNaN(settling.growth,
                                        watch.growth(cloth, before, state, report.tangle.energy));
    settling.intersects = settling.intersects || intersections.failsAt(state);
    settling.error = distanceBetween(state, rest);
    const double speed = largestSpeed(state);
    if (settling.error <= kReturnTolerance && speed <= slow) return true;
    settling.unbalanced = unbalancedOf(cloth, state, extentOf(rest));
    still = speed <= 1e-6 * slow ? still + 1 : 0;
    if (still == kStillSteps) return false;
    if (speed <= 1e-2 * slow && settling.unbalanced <= 0.1 * kBalanced) return true;  // elsewhere
    time_step = std::min(kStepGrowth * time_step, period / kStepsPerPeriod);
  }
  return false;
}

/// Out of an equilibrium that is not stable.
void push(const ExtremeCase& extreme, const cloth::Cloth& cloth, cloth::ClothState& state) {
  RepeatableRandom random(extreme.seed + 4);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) state.positions[i] += 1e-3 * extreme.cell * random.direction();
  }
}

}  // namespace

std::vector<int> attachedParticles(const ExtremeCase& extreme, const mesh::ClothMesh& mesh) {
  std::vector<int> result = sideParticles(mesh, mesh::Side::kTop);
  if (!extreme.taut) return result;
  for (mesh::Side side : {mesh::Side::kBottom, mesh::Side::kLeft, mesh::Side::kRight}) {
    const std::vector<int> more = sideParticles(mesh, side);
    result.insert(result.end(), more.begin(), more.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

cloth::Cloth clothOf(const ExtremeCase& extreme, const mesh::ClothMesh& mesh,
                     const std::optional<cloth::Air>& air) {
  cloth::ModelledEffects effects;
  effects.viscosity = extreme.viscosity > 0.0;
  effects.bending = extreme.bending > 0.0;
  effects.air = air;
  effects.self_collision = extreme.self_collision;
  if (!extreme.taut) effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  cloth::Cloth cloth(mesh, fabricOf(extreme), effects);
  for (int particle : attachedParticles(extreme, mesh)) {
    cloth::AttachmentPath place;
    place.start = mesh.initial_positions[particle];
    cloth.attach(particle, place);
  }
  return cloth;
}

cloth::ClothState restOf(const cloth::Cloth& cloth) {
  cloth::ClothState state = cloth.initialState();
  cloth::Integrator integrator(cloth, kes::solvedSettings(kNewtonTolerance));
  const double extent = extentOf(state);
  double time_step = kFirstStep;
  for (int i = 0; i < kMaxSteps; ++i) {
    if (!integrator.step(cloth, state, time_step).accepted) break;
    const double way = largestSpeed(state) * time_step;
    if (time_step == kLongestStep && way <= 1e-3 * kReturnTolerance * extent) {
      state.velocities.assign(cloth.particleCount(), Eigen::Vector3d::Zero());
      state.time = 0.0;
      return state;
    }
    time_step = std::min(kStepGrowth * time_step, kLongestStep);
  }
  throw std::runtime_error("the undisturbed cloth has not come to rest");
}

cloth::Cloth apart(const ExtremeCase& extreme, const mesh::ClothMesh& mesh,
                   const std::optional<cloth::Air>& air) {
  ExtremeCase other = extreme;
  other.self_collision = false;
  return clothOf(other, mesh, air);
}

double distanceBetween(const cloth::ClothState& state, const cloth::ClothState& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    largest = base::largerOrNaN(largest, (state.positions[i] - other.positions[i]).norm());
  }
  return largest / extentOf(other);
}

Settling settle(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                const cloth::ClothState& rest, int most_solved_steps,
                IntersectionWatch& intersections, cloth::ClothState& state) {
  constexpr int kMaxSteps = 200;
  Settling settling;
  const double period = slowestPeriod(extreme, extentOf(rest));
  settling.slow = !settleBy(settingsOf(extreme), kMaxSteps, period, cloth, rest, intersections,
                            state, settling);
  if (settling.slow && !extreme.self_collision) {
    settleBy(kes::solvedSettings(kNewtonTolerance), most_solved_steps, period, cloth, rest,
             intersections, state, settling);
  }
  return settling;
}

void settleAndJudge(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                    const cloth::ClothState& rest, int most_solved_steps,
                    IntersectionWatch& intersections, cloth::ClothState& state,
                    ExtremeOutcome& outcome) {
  Settling settling;
  const auto comes_to_rest_elsewhere = [&] {
    settling = settle(extreme, cloth, rest, most_solved_steps, intersections, state);
    outcome.growth = base::largerOrNaN(outcome.growth, settling.growth);
    outcome.rejected += settling.rejected;
    outcome.settling_steps += settling.steps;
    outcome.slow = outcome.slow || settling.slow;
    return settling.error > kReturnTolerance && settling.unbalanced <= kBalanced;
  };
  bool elsewhere = comes_to_rest_elsewhere();
  if (elsewhere && extreme.taut && !extreme.self_collision) {
    const cloth::ClothState before = state;
    push(extreme, cloth, state);
    elsewhere = comes_to_rest_elsewhere() && distanceBetween(state, before) <= kReturnTolerance;
  }
  outcome.return_error = settling.error;
  if (!isFinite(state)) {
    outcome.failure = ExtremeFailure::kNotFinite;
  } else if (!(outcome.growth <= kRoundingGrowth)) {
    outcome.failure = ExtremeFailure::kEnergyGrew;
  } else if (settling.intersects) {
    outcome.failure = ExtremeFailure::kIntersects;
  } else if (extreme.self_collision) {
    outcome.other_rest = elsewhere;
    outcome.unsettled = !(settling.error <= kReturnTolerance) && !elsewhere;
  } else if (!(settling.error <= kReturnTolerance)) {
    outcome.other_rest = elsewhere;
    if (!elsewhere) outcome.failure = ExtremeFailure::kNoReturn;
    outcome.message = "unbalanced by " + std::to_string(settling.unbalanced);
  }
}

}  // namespace haptex::studies
