// The energy that every integrator leaves of an oscillator.
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/oracles/experiments/oscillator.h"

namespace haptex::oracles {

void randomOscillator(const std::string&, Random& random, const Sink& sink) {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    cloth::StepSettings settings;
    settings.method = named.method;
    settings.solver = linear::LinearSolverMethod::kCholesky;
    settings.tolerance = 1e-10;
    const double phase = random.logarithmic(0.005, 0.3);
    const double time_step = random.logarithmic(1e-4, 0.05);
    const int steps = 1 + random.below(200);
    const double exact = oscillatorEnergy(named.method, phase, steps);
    CaseName text("cloth", "oscillator");
    text.with(named.name).with("phase", phase).with("step", time_step).with("steps", steps);
    // The equations are linear: what is left is 1e-10 of each of their solutions.
    sink(base::relativeTo(exact, text.text(), exact,
                          simulatedOscillatorEnergy(settings, phase, time_step, steps), 1e-9));
  }
}

}  // namespace haptex::oracles
