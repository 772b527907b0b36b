#include "haptex/oracles/experiments/amplification.h"

#include <cmath>
#include <complex>
#include <stdexcept>

#include "haptex/base/require.h"

namespace haptex::oracles {

using cloth::IntegrationMethod;

namespace {

void requirePhase(const char* where, double phase) {
  base::require(std::isfinite(phase) && phase >= 0.0, where, "phase", phase, "finite and >= 0");
}

}  // namespace

double amplification(IntegrationMethod method, double phase) {
  requirePhase("amplification", phase);
  const std::complex<double> z(0.0, phase);
  switch (method) {
    case IntegrationMethod::kExplicitEuler:
      return std::abs(1.0 + z);
    case IntegrationMethod::kExplicitMidpoint:
      return std::abs(1.0 + z + z * z / 2.0);
    case IntegrationMethod::kRungeKutta4:
      return std::abs(1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0);
    case IntegrationMethod::kTwoStepEuler: {
      const double half = 1.0 - 0.5 * phase * phase;  // of the trace; the determinant is 1
      return std::abs(half) <= 1.0 ? 1.0 : std::abs(half) + std::sqrt(half * half - 1.0);
    }
    default:
      throw std::invalid_argument("an implicit method has no limit of stability");
  }
}

double growthPerStep(IntegrationMethod method, double phase) {
  requirePhase("growthPerStep", phase);
  const std::complex<double> z(0.0, -phase);
  switch (method) {
    case IntegrationMethod::kBackwardEuler:
      return 1.0 / std::abs(1.0 - z);
    case IntegrationMethod::kBackwardMidpoint:
      return 1.0;
    case IntegrationMethod::kBdf2:  // the root near 1; the other dies away
      return std::abs((2.0 + std::sqrt(1.0 + 2.0 * z)) / (3.0 - 2.0 * z));
    case IntegrationMethod::kTrBdf2: {
      const double g = 2.0 - std::sqrt(2.0);
      const std::complex<double> middle = (1.0 + 0.5 * g * z) / (1.0 - 0.5 * g * z);
      return std::abs((middle - (1.0 - g) * (1.0 - g)) / (g * (2.0 - g - (1.0 - g) * z)));
    }
    default:
      return amplification(method, phase);
  }
}

}  // namespace haptex::oracles
