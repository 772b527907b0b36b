// Cantilevers against the elastica: along the threads, and oblique to them.
#include <algorithm>
#include <cmath>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles {
namespace {

void validate(const char* name, Cantilever cantilever, Random& random, const Sink& sink) {
  cantilever.gamma = random.logarithmic(0.1, 300.0);
  cantilever.cells = 60 + random.below(31);
  const NamedStripMesh& mesh = kStripMeshes[random.below(3)];
  cantilever.mesh = mesh.mesh;
  cantilever.seed = 1 + random.below(1000000);
  cantilever.along = random.chance(0.5) ? kes::Direction::kWeft : kes::Direction::kWarp;
  const bool linear = random.chance(0.5);
  cantilever.model = linear ? cloth::BendingModel::kLinear : cloth::BendingModel::kQuadratic;
  const double exact = exactDropOverReach(cantilever.gamma);
  CaseName text("cloth", name);
  text.with(linear ? "linear" : "quadratic").with(mesh.name).with(nameOf(cantilever.along));
  text.with("gamma", cantilever.gamma).with("cells", cantilever.cells);
  text.with("across", cantilever.across).with("grain", cantilever.grain);
  // Of second order in the cell over the length 1 / sqrt(gamma) of the bend at the clamp, and at
  // most what the fixed cases may have.
  const double tolerance =
      std::min(0.02, 2.0 * (1.0 + cantilever.gamma) / (cantilever.cells * cantilever.cells));
  sink(base::relativeTo(exact, text.text(), exact, simulatedDropOverReach(cantilever), tolerance));
}

}  // namespace

void randomElastica(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < base::unlessSanitized(3, 1); ++i) {
    Cantilever along;
    along.across = random.logarithmic(0.2, 10.0);
    validate("elastica", along, random, sink);
    if (base::kSanitized) break;
    Cantilever oblique;
    oblique.across = 1.0;
    oblique.grain = random.uniform(-0.5 * M_PI, 0.5 * M_PI);
    validate("elastica/oblique", oblique, random, sink);
  }
}

}  // namespace haptex::oracles
