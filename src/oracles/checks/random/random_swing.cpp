// A sheet that swings: its energy stays.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/cloth_swing.h"

namespace haptex::oracles {

namespace {

constexpr double kMaxLoss = 0.01;  // in a period, as of the fixed cases

}  // namespace

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
    // It starts as a chain hangs, not quite as the sheet does: what it can settle by is an energy
    // that these methods may take, the same for any amplitude.
    const ClothSwing hanging(material::linearFabric(modulus), cells, 0.0);
    const double settling = -hanging.energy(hanging.swing({}, 10.0, 200).end);
    const double start = motion.energies.front(), end = motion.energies.back();
    const double outside = std::max({0.0, end - start, start - settling - end});
    CaseName text("cloth", "swing");
    text.with(nameOf(method)).with("modulus", modulus).with("amplitude", amplitude);
    text.with("cells", cells).with("steps", steps).with("settling", settling / start);
    sink({text.text() + "/energy_left", 1.0, end / start,
          motion.accepted ? outside / start : std::nan(""), kMaxLoss});
  }
}

}  // namespace haptex::oracles
