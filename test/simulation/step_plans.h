// A small scene with a plan for every kind of step.
#pragma once

#include <vector>

#include "small_scene.h"

namespace haptex::simulation {

inline std::vector<StepPlan> severalPlans() {
  const auto settings = [](cloth::IntegrationMethod method, int newton_iterations) {
    cloth::StepSettings step;
    step.method = method;
    step.newton_iterations = newton_iterations;
    return step;
  };
  return {{settings(cloth::IntegrationMethod::kBackwardEuler, 1), 1},
          {settings(cloth::IntegrationMethod::kBackwardMidpoint, 2), 2},
          {settings(cloth::IntegrationMethod::kBdf2, 1), 3},
          {settings(cloth::IntegrationMethod::kTrBdf2, 3), 1}};
}

inline SimulatedCloth plannedSimulation(std::vector<StepPlan> plans = severalPlans(),
                                        bool bending_hysteresis = false) {
  scene::Scene scene = smallScene();
  scene.effects.bending = scene.effects.bending_hysteresis = bending_hysteresis;
  return SimulatedCloth(std::move(scene), smallFabric(), std::move(plans));
}

}  // namespace haptex::simulation
