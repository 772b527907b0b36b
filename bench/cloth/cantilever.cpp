// How fast do strips that bend converge under refinement? Prints by how much the tip drop over
// reach of a clamped strip differs from the elastica's, for both models of bending, three
// triangulations and four loads. The elapsed time is not measured; scripts/plot_cantilever draws
// the lines.
#include <cmath>
#include <string>

#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/strip_statics.h"
#include "tab_lines.h"

int main() {
  using namespace haptex;
  for (const auto& [model, model_name] :
       {std::pair(cloth::BendingModel::kLinear, "linear"),
        std::pair(cloth::BendingModel::kQuadratic, "quadratic")}) {
    for (const auto& [mesh_name, mesh] : oracles::kStripMeshes) {
      for (const auto& [gamma, gamma_name] : {std::pair(0.1, "0.1"), std::pair(1.0, "1"),
                                              std::pair(10.0, "10"), std::pair(100.0, "100")}) {
        const double exact = oracles::exactDropOverReach(gamma);
        for (int cells : {8, 12, 16, 24, 32, 48, 64, 96, 128}) {
          oracles::Cantilever cantilever{gamma, mesh};
          cantilever.cells = cells;
          cantilever.model = model;
          const double error = oracles::simulatedDropOverReach(cantilever) / exact - 1.0;
          bench::printLine(std::string("cantilever/") + model_name + "/" + mesh_name + "/gamma" +
                               gamma_name + "/" + std::to_string(12 * cells),
                           100.0 * std::abs(error), "%");
        }
      }
    }
  }
}
