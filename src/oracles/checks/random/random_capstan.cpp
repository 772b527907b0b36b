// Strips that are drawn over capsules: the capstan equation, and friction inside of its cone.
#include <algorithm>
#include <string>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/capstan.h"

namespace haptex::oracles {

void randomCapstan(const std::string& config_directory, Random& random, const Sink& sink) {
  constexpr double kCone = 1e-9;  // rounding of |T| / (mu N)
  for (int i = 0; i < base::unlessSanitized(3, 1); ++i) {
    CapstanCase capstan = drawCapstan(config_directory, random);
    capstan.steps = 200;
    const CapstanOutcome outcome = pullOverCapstan(capstan);
    CaseName name("contact", "capstan");
    name.with(capstan.fabric.name).with("mu", capstan.friction).with("wrap", capstan.wrap);
    name.with("step", capstan.time_step).with("speed", capstan.speed).with("cell", capstan.cell);
    sink(base::relativeTo(outcome.exact, name.text(), outcome.exact, outcome.ratio, 0.01));
    CaseName cone = name;
    cone.with("particle_over_limit");
    sink({cone.text(), 1.0, outcome.particle, std::max(0.0, outcome.particle - 1.0), kCone});
  }
}

}  // namespace haptex::oracles
