#include "haptex/cloth/dynamics/explicit_step.h"

namespace haptex::cloth {
namespace {

/// A Runge-Kutta method each of whose stages starts from the slope of the one before alone:
///   k_i = f(y + nodes[i] h k_(i-1)),  y += h sum_i weights[i] k_i.
struct Tableau {
  int stages;
  double nodes[4];
  double weights[4];
};

constexpr Tableau kEuler = {1, {0.0}, {1.0}};
constexpr Tableau kMidpoint = {2, {0.0, 0.5}, {0.0, 1.0}};
constexpr Tableau kRungeKutta4 = {
    4, {0.0, 0.5, 0.5, 1.0}, {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}};

const Tableau& tableauOf(IntegrationMethod method) {
  if (method == IntegrationMethod::kRungeKutta4) return kRungeKutta4;
  return method == IntegrationMethod::kExplicitMidpoint ? kMidpoint : kEuler;
}

void followPaths(const Cloth& cloth, double time, ClothState& state) {
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const auto& attachment = cloth.attachments()[i];
    if (!attachment) continue;
    state.positions[i] = attachment->position(time);
    state.velocities[i] = attachment->velocity(time);
  }
  // Tied particles have no mass: what was computed for them is not a number.
  cloth.ties().place(time, state.positions);
  cloth.ties().carry(time, state.velocities);
}

}  // namespace

ExplicitStep::ExplicitStep(const Cloth& cloth, IntegrationMethod method)
    : method_(method), forces_(cloth.particleCount()) {
  if (tableauOf(method).stages > 1) stage_ = cloth.initialState();
}

void ExplicitStep::advance(const Cloth& cloth, const ClothState& begin, double time_step,
                           ClothState& end) {
  const Tableau& tableau = tableauOf(method_);
  end.positions = begin.positions;
  end.velocities = begin.velocities;
  if (tableau.stages > 1) stage_.memory = begin.memory;
  const ClothState* at = &begin;
  for (int s = 0; s < tableau.stages; ++s) {
    if (s > 0) {
      moveToStage(cloth, begin, *at, tableau.nodes[s] * time_step);
      at = &stage_;
    }
    cloth.computeForces(*at, forces_);
    const double weight = tableau.weights[s] * time_step;
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      end.positions[i] += weight * at->velocities[i];
      end.velocities[i] += weight / cloth.masses()[i] * forces_[i];
    }
  }
  if (method_ == IntegrationMethod::kTwoStepEuler) {
    for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
      end.positions[i] = begin.positions[i] + time_step * end.velocities[i];
    }
  }
  followPaths(cloth, begin.time + time_step, end);
}

/// @param previous stage, with its forces in forces_; may be stage_ itself
void ExplicitStep::moveToStage(const Cloth& cloth, const ClothState& begin,
                               const ClothState& previous, double interval) {
  stage_.time = begin.time + interval;
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    stage_.positions[i] = begin.positions[i] + interval * previous.velocities[i];
    stage_.velocities[i] = begin.velocities[i] + interval / cloth.masses()[i] * forces_[i];
  }
  followPaths(cloth, stage_.time, stage_);
}

}  // namespace haptex::cloth
