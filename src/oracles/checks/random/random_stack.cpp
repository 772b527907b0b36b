// Layers of any fabric on each other: the height that its compression curve gives.
#include "haptex/base/workload.h"
#include "haptex/material/compression.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/scenes/self_collision_scenes.h"

namespace haptex::oracles {

void randomStack(const std::string&, Random& random, const Sink& sink) {
  material::Fabric fabric = material::linearFabric(random.logarithmic(100.0, 1e4), 1.0);
  fabric.areal_density = random.logarithmic(0.05, 0.5);
  fabric.friction = random.uniform(0.1, 0.5);
  // Above half of the thickness, so that only neighbours touch.
  const double thickness = random.logarithmic(2e-4, 2e-3);
  fabric.compression = material::compressionFromPoints(
      {{0.0, thickness},
       {material::kKesLowPressure, thickness * random.uniform(0.8, 0.95)},
       {material::kKesHighPressure, thickness * random.uniform(0.55, 0.7)}});
  const int layers = 2 + random.below(7);
  const LayerStack stack = restingStack({fabric}, layers, base::unlessSanitized(80, 10));
  CaseName text("self_collision", "stack");
  text.with("layers", layers).with("density", fabric.areal_density).with("thickness", thickness);
  sink(base::relativeTo(stack.exact, text.text(), stack.exact, stack.height,
                        base::unlessSanitized(1e-3, 1e-2)));
}

}  // namespace haptex::oracles
