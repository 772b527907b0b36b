// The oracles of the integrators of the cloth room.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/oracles/experiments/cloth_swing.h"
#include "haptex/oracles/experiments/oscillator.h"
#include "haptex/oracles/experiments/sample_swing.h"

namespace haptex::oracles {
namespace {

using cloth::IntegrationMethod;
using cloth::StepSettings;

constexpr double kSwingStep = 0.0125;               // s
constexpr double kPhase = 2.0 * M_PI * kSwingStep;  // of a 1 Hz oscillator per step
constexpr int kStepsPerPeriod = 80;
constexpr double kOrderTolerance = 0.1;    // what terms of higher order still add
constexpr double kEnergyTolerance = 2e-4;  // the two-step Euler ends a little out of phase
constexpr double kMaxLoss = 0.01;          // of the energy per period, second-order methods

/// @param solves per stage
StepSettings settingsOf(IntegrationMethod method, int solves) {
  StepSettings settings;
  settings.method = method;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  settings.tolerance = 1e-10;
  settings.newton_iterations = solves;
  return settings;
}

int orderOf(IntegrationMethod method) {
  switch (method) {
    case IntegrationMethod::kBackwardEuler:
    case IntegrationMethod::kExplicitEuler:
    case IntegrationMethod::kTwoStepEuler:
      return 1;
    case IntegrationMethod::kRungeKutta4:
      return 4;
    default:
      return 2;
  }
}

double distance(const cloth::ClothState& a, const cloth::ClothState& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    sum += (a.positions[i] - b.positions[i]).squaredNorm();
  }
  return std::sqrt(sum);
}

/// How often the error of a swing's positions halves when the step does. The fabric is so soft and
/// the mesh so coarse that the steps resolve the fastest vibration.
void validateOrders(const Sink& sink) {
  constexpr double kDuration = 0.1;  // s
  constexpr int kSteps = 1024;
  material::Fabric soft;
  soft.areal_density = 0.1;
  soft.weft.elastic = soft.warp.elastic = material::StrainStressCurve::linear(5.0);
  soft.shear.elastic = material::StrainStressCurve::linear(2.5);
  const ClothSwing swing(soft, 4, 0.05);
  const auto end = [&](IntegrationMethod method, int steps) {
    return swing.swing(settingsOf(method, 2), kDuration, steps).end;
  };
  const cloth::ClothState exact = end(IntegrationMethod::kRungeKutta4, 16 * kSteps);
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    const double order = std::log2(distance(end(named.method, kSteps), exact) /
                                   distance(end(named.method, 2 * kSteps), exact));
    const double expected = orderOf(named.method);
    sink({std::string("cloth/integrator/") + named.name + "/order", expected, order,
          std::abs(order - expected), kOrderTolerance});
  }
}

/// Over four periods.
double lossPerPeriod(const ClothSwing& swing, const StepSettings& settings) {
  constexpr int kPeriods = 4;
  const ClothSwing::Motion motion =
      swing.swing(settings, kPeriods * kStepsPerPeriod * kSwingStep, kPeriods * kStepsPerPeriod);
  if (!motion.accepted) return std::nan("");
  return 1.0 - std::pow(motion.energies.back() / motion.energies.front(), 1.0 / kPeriods);
}

/// A sample let go from 0.5 rad, in steps that end by their error: what it has of its energy after
/// a second, with the cells of the scenes of samples, and the order of its positions after a
/// quarter of a second.
void validateSampleSwing(const material::Fabric& fabric, const Sink& sink) {
  constexpr double kAngle = 0.5;  // rad
  constexpr int kCells = base::unlessSanitized(32, 12), kCoarse = base::unlessSanitized(16, 6);
  constexpr double kOrderBound = 0.2, kMostLost = 0.03;
  const SampleSwing sample(fabric, kCells, kAngle), coarse(fabric, kCoarse, kAngle);
  for (const IntegrationMethod method : {IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    StepSettings settings;
    settings.method = method;
    settings.newton_iterations = 30;
    settings.newton_error = 1e-3;
    const std::string name = "cloth/sample_swing/" + fabric.name + "/" + nameOf(method);
    const SampleSwing::Motion motion = sample.swing(settings, 1.0, kStepsPerPeriod);
    sink({name + "/kept_per_second", 1.0, motion.kept,
          motion.accepted ? std::abs(1.0 - motion.kept) : std::nan(""), kMostLost});
    const double order = orderOfSwing(coarse, settings, 0.25);
    sink({name + "/order", 2.0, order, std::abs(order - 2.0), kOrderBound});
  }
}

}  // namespace

void validateIntegrators(const material::Fabric& linear, const material::Fabric& wool,
                         const Sink& sink) {
  validateOrders(sink);
  const ClothSwing linear_swing(linear, 32, 0.05), wool_swing(wool, 32, 0.05);
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    const std::string name = std::string("cloth/integrator/") + named.name;
    const double exact = std::pow(growthPerStep(named.method, kPhase), 2 * kStepsPerPeriod);
    sink(base::relativeTo(
        1.0, name + "/oscillator_energy", exact,
        simulatedOscillatorEnergy(settingsOf(named.method, 1), kPhase, kSwingStep, kStepsPerPeriod),
        kEnergyTolerance));
    if (!isImplicit(named.method) || orderOf(named.method) < 2) continue;
    const auto sink_loss = [&](const std::string& of, const ClothSwing& swing, int solves) {
      const double loss = lossPerPeriod(swing, settingsOf(named.method, solves));
      sink({name + "/swing_loss/" + of, 0.0, loss, std::abs(loss), kMaxLoss});
    };
    sink_loss(linear.name, linear_swing, 2);
    // The midpoint rule stretches a stiff cloth at the ends of its steps, and has to be damped.
    if (named.method == IntegrationMethod::kBackwardMidpoint) continue;
    sink_loss(wool.name, wool_swing, 20);
  }
  validateSampleSwing(linear, sink);
  validateSampleSwing(wool, sink);
}

}  // namespace haptex::oracles
