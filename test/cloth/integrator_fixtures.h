// What the tests of the integrators share.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "haptex/cloth/dynamics/step.h"

namespace haptex::cloth {

/// Linear systems solved to rounding.
inline StepSettings settingsOf(IntegrationMethod method, int newton_iterations = 1) {
  StepSettings settings;
  settings.method = method;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  settings.tolerance = 1e-12;
  settings.newton_iterations = newton_iterations;
  settings.newton_tolerance = 1e-12;
  return settings;
}

inline std::string nameOfIntegrator(const testing::TestParamInfo<NamedIntegrationMethod>& info) {
  return info.param.name;
}

}  // namespace haptex::cloth
