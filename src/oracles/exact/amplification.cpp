#include "haptex/oracles/exact/amplification.h"

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

/// Factor of y' = z y / (time step) in a step.
std::complex<double> stepOfTrBdf2(const std::complex<double>& z) {
  const double g = 2.0 - std::sqrt(2.0);
  const std::complex<double> middle = (1.0 + 0.5 * g * z) / (1.0 - 0.5 * g * z);
  return (middle - (1.0 - g) * (1.0 - g)) / (g * (2.0 - g - (1.0 - g) * z));
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

double oscillatorEnergy(IntegrationMethod method, double phase, int steps) {
  requirePhase("oscillatorEnergy", phase);
  base::require(steps >= 0, "oscillatorEnergy", "steps", steps, ">= 0");
  using Complex = std::complex<double>;
  if (method == IntegrationMethod::kBdf2) {
    // Its real and imaginary part are displacement and velocity, scaled to the same energy.
    const Complex z(0.0, -phase);
    Complex before = 1.0, now = stepOfTrBdf2(z);
    if (steps == 0) return 1.0;
    for (int i = 1; i < steps; ++i) {
      const Complex next = (4.0 * now - before) / (3.0 - 2.0 * z);
      before = now;
      now = next;
    }
    return std::norm(now);
  }
  if (method == IntegrationMethod::kTwoStepEuler) {  // velocities, then positions from them
    double position = 1.0, velocity = 0.0;
    for (int i = 0; i < steps; ++i) {
      velocity -= phase * position;
      position += phase * velocity;
    }
    return position * position + velocity * velocity;
  }
  return std::pow(growthPerStep(method, phase), 2.0 * steps);
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
    case IntegrationMethod::kTrBdf2:
      return std::abs(stepOfTrBdf2(z));
    default:
      return amplification(method, phase);
  }
}

}  // namespace haptex::oracles
