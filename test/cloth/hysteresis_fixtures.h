// What the tests of friction in bent and in stretched fabric share. A sheet has a cloth, a state of
// it and its energy().
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/cloth/dynamics/integrator.h"

namespace haptex::cloth {

/// How many numbers that friction remembers would follow a step that ended here.
inline int yieldingIn(const Cloth& cloth, const ClothState& state) {
  ClothState followed = state;
  cloth.remember(followed);
  int yielding = 0;
  for (std::size_t i = 0; i < state.memory.size(); ++i) {
    yielding += followed.memory[i] != state.memory[i];
  }
  return yielding;
}

template <typename Sheet>
void run(Sheet& sheet, IntegrationMethod method, int newton_iterations, int steps,
         double time_step) {
  StepSettings settings;
  settings.method = method;
  settings.newton_iterations = newton_iterations;
  Integrator integrator(sheet.cloth, settings);
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(integrator.step(sheet.cloth, sheet.state, time_step).accepted);
  }
}

/// Two methods for which the sum of energies must not grow: backward Euler always, the midpoint by
/// its adaptive damping. Both up to what Newton iterations leave open.
/// @param least_lost share of the energy that a hundred steps take at least
template <typename MakeSheet>
void expectEnergyNeverGrows(const MakeSheet& make, double time_step, double least_lost) {
  for (IntegrationMethod method :
       {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBackwardMidpoint}) {
    auto sheet = make();
    StepSettings settings;
    settings.method = method;
    settings.tolerance = 1e-9;
    settings.newton_iterations = 60;
    Integrator integrator(sheet.cloth, settings);
    double before = sheet.energy();
    const double first = before;
    for (int step = 0; step < 100; ++step) {
      ASSERT_TRUE(integrator.step(sheet.cloth, sheet.state, time_step).accepted);
      const double now = sheet.energy();
      EXPECT_LE(now, before + 1e-7 * first) << step;
      before = now;
    }
    EXPECT_LT(before, (1.0 - least_lost) * first);
  }
}

template <typename Sheet>
void expectARejectedStepToLeaveThePastAlone(Sheet& sheet) {
  const ClothState before = sheet.state;
  sheet.cloth.setExternalForce(3, Eigen::Vector3d::Constant(std::numeric_limits<double>::max()));
  Integrator integrator(sheet.cloth, StepSettings());
  EXPECT_FALSE(integrator.step(sheet.cloth, sheet.state, 0.01).accepted);
  EXPECT_EQ(sheet.state.memory, before.memory);
  EXPECT_EQ(sheet.state.positions, before.positions);
}

inline std::string refusal(const material::Fabric& fabric, const ModelledEffects& effects) {
  return test::refusalOf([&] { const Cloth cloth(square(2), fabric, effects); });
}

}  // namespace haptex::cloth
