// Strips that hang under their own weight.
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles {

void randomHangingStrip(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < base::unlessSanitized(5, 1); ++i) {
    HangingStrip strip;
    strip.length = random.uniform(0.1, 1.0);
    strip.areal_density = random.logarithmic(0.02, 1.0);
    strip.gravity = random.uniform(1.0, 20.0);
    const double load = random.logarithmic(1e-3, 0.5);  // weight over modulus
    strip.modulus = strip.areal_density * strip.gravity * strip.length / load;
    const int cells = 5 * (4 + random.below(5));
    // Of the slowest vibration, as simulatedElongation() has it.
    const double time_step = random.logarithmic(0.05, 3.0) * strip.length /
                             (0.5 * M_PI * std::sqrt(strip.modulus / strip.areal_density));
    const double exact = exactElongation(strip);
    CaseName text("cloth", "hanging_strip");
    text.with("load", load).with("length", strip.length).with("cells", cells);
    text.with("step", time_step);
    // Each row of elements has one stretch, that of the load in its middle: with |d^2 l / d load^2|
    // <= 3 the midpoint rule errs by at most load / 4 of load / 2 (1 - load + ...) per cells^2.
    // What diagonals make uneven in a row adds 0.04, the tolerance of the fixed cases.
    const double tolerance = (0.04 + 0.5 * load) / (cells * cells);
    sink(base::relativeTo(exact, text.text(), exact, simulatedElongation(strip, cells, time_step),
                          tolerance));
  }
}

}  // namespace haptex::oracles
