// Sheets on inclines: they stick, or slide with what friction leaves of the weight.
#include <cmath>

#include "haptex/base/constants.h"
#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/scenes/obstacle_scenes.h"

namespace haptex::oracles {

void randomIncline(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < base::unlessSanitized(3, 1); ++i) {
    const cloth::NamedIntegrationMethod& method = cloth::kIntegrationMethods[random.below(4)];
    const double angle = random.uniform(0.05, 0.8);            // rad
    const double time_step = 0.25 / (20 + random.below(100));  // s
    const double share = random.uniform(0.0, 0.95);            // of what would hold it
    const double friction = share * std::tan(angle);
    const double exact = base::kStandardGravity * (std::sin(angle) - friction * std::cos(angle));
    CaseName slides("contact", "incline_slides");
    slides.with(method.name).with("angle", angle).with("friction", friction);
    slides.with("step", time_step);
    sink(base::relativeTo(exact, slides.text(), exact,
                          slideDown(angle, friction, method.method, time_step).acceleration, 1e-4));
    const double holding = random.uniform(1.01, 3.0) * std::tan(angle);
    const double way = std::abs(slideDown(angle, holding, method.method, time_step).way);
    CaseName sticks("contact", "incline_sticks_m");
    sticks.with(method.name).with("angle", angle).with("friction", holding);
    sticks.with("step", time_step);
    sink({sticks.text(), 0.0, way, way, 1e-9});
  }
}

}  // namespace haptex::oracles
