// A sheet that swings: its energy stays.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/oracles/experiments/cloth_swing.h"

namespace haptex::oracles {

void randomSwing(const std::string&, Random& random, const Sink& sink) {
  constexpr cloth::IntegrationMethod kMethods[] = {cloth::IntegrationMethod::kBackwardMidpoint,
                                                   cloth::IntegrationMethod::kBdf2,
                                                   cloth::IntegrationMethod::kTrBdf2};
  for (const cloth::IntegrationMethod method : kMethods) {
    cloth::StepSettings settings;
    settings.method = method;
    settings.solver = linear::LinearSolverMethod::kCholesky;
    settings.tolerance = 1e-10;
    settings.newton_iterations = 3;
    const double modulus = random.logarithmic(30.0, 300.0);   // N/m
    const double amplitude = random.logarithmic(1e-3, 0.05);  // m
    const int cells = 8 + random.below(base::unlessSanitized(25, 1));
    const int steps = 100 + random.below(100);
    const ClothSwing swing(material::linearFabric(modulus), cells, amplitude);
    const ClothSwing::Motion motion = swing.swing(settings, 1.0, steps);
    const double left = motion.energies.back() / motion.energies.front();
    CaseName text("cloth", "swing");
    text.with(nameOf(method)).with("modulus", modulus).with("amplitude", amplitude);
    text.with("cells", cells).with("steps", steps);
    sink({text.text(), 1.0, motion.accepted ? left : std::nan(""), std::abs(1.0 - left), 0.01});
  }
}

}  // namespace haptex::oracles
