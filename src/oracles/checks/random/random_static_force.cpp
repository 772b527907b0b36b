// A constant force in any pose, in any direction, through the simulated loop of the device.
#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/finger_geometry.h"
#include "haptex/oracles/experiments/device/static_force.h"

namespace haptex::oracles {

void randomStaticForce(const std::string& config_directory, Random& random, const Sink& sink) {
  constexpr double kTolerance = 0.005;  // N, the resolution of the HAPTEX exoskeleton
  std::vector<double> forces;
  for (int i = 0; i < 2; ++i) forces.push_back(random.logarithmic(0.05, 5.0));
  const unsigned seed = 1 + random.below(1000000);
  for (const StaticForce& found :
       staticForces(shippedUrdf(config_directory), base::unlessSanitized(2, 1), forces, seed)) {
    CaseName text("exoskeleton", std::string("static_force_N/") + base::name(found.finger));
    text.with("force", found.commanded.norm()).with("seed", seed);
    sink({text.text(), found.commanded.norm(), found.measured.norm(), found.error(), kTolerance});
  }
}

}  // namespace haptex::oracles
