#include "haptex/oracles/experiments/amplification.h"

#include <cmath>
#include <complex>
#include <stdexcept>

namespace haptex::oracles {

using cloth::IntegrationMethod;

double amplification(IntegrationMethod method, double phase) {
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

}  // namespace haptex::oracles
