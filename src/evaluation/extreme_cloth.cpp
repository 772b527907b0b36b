#include "haptex/evaluation/extreme_cloth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptex/evaluation/extreme_run.h"
#include "haptex/evaluation/quantity.h"

namespace haptex::evaluation {
namespace {

constexpr double kGravity = 9.80665;   // m/s^2
constexpr double kFirstStep = 0.01;    // s
constexpr double kLongestStep = 30.0;  // s
constexpr double kStepGrowth = 1.3;    // from step to step
constexpr int kMostSteps = 400;

cloth::StepSettings solvedSettings() {
  cloth::StepSettings settings;
  settings.solver = cloth::LinearSolverMethod::kCholesky;
  settings.tolerance = 1e-9;
  settings.newton_iterations = 100;
  settings.keep_energy = true;
  settings.newton_tolerance = 1e-12;
  return settings;
}

double largestSpeed(const cloth::ClothState& state) {
  double largest = 0.0;
  for (const Eigen::Vector3d& velocity : state.velocities) {
    largest = largerOrNaN(largest, velocity.norm());
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
  if (!extreme.taut) return std::max(decay, 2.0 * M_PI * std::sqrt(extent / kGravity));
  const double tension = std::min(extreme.weft, extreme.warp) * extreme.strain;
  return std::max(decay, 2.0 * extent * std::sqrt(extreme.density / tension));
}

double unbalancedOf(const cloth::Cloth& cloth, const cloth::ClothState& state) {
  std::vector<Eigen::Vector3d> forces;
  cloth.computeForces(state, forces);
  double held = 0.0, free = 0.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    double& largest = cloth.attachments()[i] ? held : free;
    largest = largerOrNaN(largest, forces[i].norm());
  }
  return free / held;
}

cloth::StepSettings settingsOf(const ExtremeCase& extreme) {
  cloth::StepSettings settings;
  settings.newton_iterations = extreme.newton_iterations;
  settings.keep_energy = true;
  return settings;
}

/// Steps until the cloth is at rest; false if it is not after kMostSettlingSteps.
bool settleBy(const cloth::StepSettings& settings, double period, const cloth::Cloth& cloth,
              const cloth::ClothState& rest, cloth::ClothState& state, Settling& settling) {
  constexpr double kStepsPerPeriod = 6.0;
  constexpr int kMostSettlingSteps = 200;
  cloth::Integrator integrator(cloth, settings);
  const double slow = kReturnTolerance * extentOf(rest) / period;  // m/s
  double time_step = std::min(kFirstStep, period / kStepsPerPeriod);
  for (int i = 0; i < kMostSettlingSteps; ++i) {
    if (!integrator.step(cloth, state, time_step).accepted) ++settling.rejected;
    ++settling.steps;
    settling.error = distanceBetween(state, rest);
    const double speed = largestSpeed(state);
    if (settling.error <= kReturnTolerance && speed <= slow) return true;
    settling.unbalanced = unbalancedOf(cloth, state);
    if (speed <= 1e-2 * slow && settling.unbalanced <= 0.1 * kBalanced) return true;  // elsewhere
    time_step = std::min(kStepGrowth * time_step, period / kStepsPerPeriod);
  }
  return false;
}

}  // namespace

std::vector<int> attachedParticles(const ExtremeCase& extreme, const cloth::ClothMesh& mesh) {
  std::vector<int> result = sideParticles(mesh, cloth::Side::kTop);
  if (!extreme.taut) return result;
  for (cloth::Side side : {cloth::Side::kBottom, cloth::Side::kLeft, cloth::Side::kRight}) {
    const std::vector<int> more = sideParticles(mesh, side);
    result.insert(result.end(), more.begin(), more.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

cloth::Cloth clothOf(const ExtremeCase& extreme, const cloth::ClothMesh& mesh,
                     const std::optional<cloth::Air>& air) {
  cloth::ModelledEffects effects;
  effects.viscosity = extreme.viscosity > 0.0;
  effects.bending = extreme.bending > 0.0;
  effects.air = air;
  if (!extreme.taut) effects.gravity = {0.0, 0.0, -kGravity};
  cloth::Cloth cloth(mesh, fabricOf(extreme), effects);
  for (int particle : attachedParticles(extreme, mesh)) {
    cloth::AttachmentPath place;
    place.start = mesh.initial_positions[particle];
    cloth.attach(particle, place);
  }
  return cloth;
}

double energyOf(const cloth::Cloth& cloth, const cloth::ClothState& state) {
  double energy = cloth.potentialEnergy(state);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    energy += 0.5 * cloth.masses()[i] * state.velocities[i].squaredNorm();
  }
  return energy;
}

double weightScale(const cloth::Cloth& cloth, const cloth::ClothState& state) {
  double scale = 0.0;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    scale += cloth.masses()[i] * cloth.effects().gravity.norm() * state.positions[i].norm();
  }
  return scale;
}

bool isFinite(const cloth::ClothState& state) {
  const auto finite = [](const Eigen::Vector3d& vector) { return vector.allFinite(); };
  return std::isfinite(state.time) &&
         std::all_of(state.positions.begin(), state.positions.end(), finite) &&
         std::all_of(state.velocities.begin(), state.velocities.end(), finite);
}

cloth::ClothState restOf(const cloth::Cloth& cloth) {
  cloth::ClothState state = cloth.initialState();
  cloth::Integrator integrator(cloth, solvedSettings());
  const double extent = extentOf(state);
  double time_step = kFirstStep;
  for (int i = 0; i < kMostSteps; ++i) {
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

double distanceBetween(const cloth::ClothState& state, const cloth::ClothState& other) {
  double largest = 0.0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    largest = largerOrNaN(largest, (state.positions[i] - other.positions[i]).norm());
  }
  return largest / extentOf(other);
}

Settling settle(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                const cloth::ClothState& rest, cloth::ClothState& state) {
  Settling settling;
  for (const cloth::StepSettings& settings : {settingsOf(extreme), solvedSettings()}) {
    settling.slow = settings.newton_iterations == solvedSettings().newton_iterations;
    if (settleBy(settings, slowestPeriod(extreme, extentOf(rest)), cloth, rest, state, settling)) {
      break;
    }
  }
  return settling;
}

void settleAndJudge(const ExtremeCase& extreme, const cloth::Cloth& cloth,
                    const cloth::ClothState& rest, cloth::ClothState& state,
                    ExtremeOutcome& outcome) {
  const Settling settling = settle(extreme, cloth, rest, state);
  outcome.rejected += settling.rejected;
  outcome.return_error = settling.error;
  outcome.settling_steps = settling.steps;
  outcome.slow = settling.slow;
  if (!isFinite(state)) {
    outcome.failure = ExtremeFailure::kNotFinite;
  } else if (!(settling.error <= kReturnTolerance)) {
    outcome.other_rest = !extreme.taut && settling.unbalanced <= kBalanced;
    if (!outcome.other_rest) outcome.failure = ExtremeFailure::kNoReturn;
    outcome.message = "unbalanced by " + std::to_string(settling.unbalanced);
  }
}

}  // namespace haptex::evaluation
