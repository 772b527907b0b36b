// A limp strip that drapes between its ends: the catenary.
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles {

void randomDrape(const std::string&, Random& random, const Sink& sink) {
  const double slack = random.uniform(1.2, 4.0);
  const int cells = 2 * (30 + random.below(21));
  const NamedStripMesh& mesh = kStripMeshes[random.below(3)];
  const double exact = exactSagOverSpan(slack);
  CaseName text("cloth", "drape/catenary");
  text.with(mesh.name).with("slack", slack).with("cells", cells);
  // A chain of links sags by their number to the power -2 otherwise; what diagonals make uneven
  // between them is of the same order.
  const double tolerance = 5.0 / (cells * cells);
  sink(base::relativeTo(exact, text.text(), exact, simulatedSagOverSpan(mesh.mesh, cells, slack),
                        tolerance));
}

}  // namespace haptex::oracles
