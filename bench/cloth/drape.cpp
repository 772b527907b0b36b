// Drape of the fabrics whose drape was measured, as a distribution: mean and standard deviation of
// the drape coefficient and median of the folds over kStarts starts, beside what was measured.
// drape/<fabric>/coefficient/<what> is the coefficient of one start with another time step (ms),
// another mesh (triangles), or with one property of the fabric changed, to be compared with that of
// the same start, drape/<fabric>/coefficient/start_1; likewise folds. bench_drape CSV also writes
// the first draped shape of each fabric for scripts/plot_drape.
//
// Measured: Matsudaira, Masuda, Wada, Yokura 2015, J. Textile Eng. 61(6):69-73, as transcribed in
// the public repository antonbj3/3fold-motion-engine. The diameters of fabric and support are not
// in the transcription: 254 mm on 127 mm is the usual pair for this apparatus.
#include "haptex/studies/drape.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "haptex/linear/thread_pool.h"
#include "haptex/material/fabric_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

struct Measured {
  const char* file;
  double coefficient;  // %
  double nodes;
};

constexpr Measured kMeasured[] = {{"cotton_poplin", 82.9, 2}, {"wool_tropical", 49.8, 5}};
constexpr int kStarts = 20;
constexpr int kThreads = 2;

struct Case {
  std::string name;  // of a line
  material::Fabric fabric;
  studies::DrapeTest test;
  unsigned seed;
};

void writeShape(const char* fabric, const mesh::ClothMesh& shape, std::ostream& csv) {
  for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
    for (const int particle : shape.triangles[i]) {
      const Eigen::Vector3d& place = shape.initial_positions[particle];
      csv << fabric << ',' << i << ',' << place.x() << ',' << place.y() << ',' << place.z() << '\n';
    }
  }
}

/// The starts, and then what is changed one by one.
std::vector<Case> casesOf(const material::Fabric& fabric) {
  std::vector<Case> cases;
  for (int seed = 1; seed <= kStarts; ++seed) {
    cases.push_back({"start_" + std::to_string(seed), fabric, {}, static_cast<unsigned>(seed)});
  }
  const auto add = [&](const std::string& name) -> Case& {
    cases.push_back({name, fabric, {}, 1});
    return cases.back();
  };
  add("step_2.5").test.time_step = 0.0025;
  add("step_12.5").test.time_step = 0.0125;
  add("triangles_3193").test.cell = 2.6e-3;
  add("triangles_5624").test.cell = 1.6e-3;
  add("triangles_11450").test.cell = 0.8e-3;
  add("lowered_half_as_fast").test.lowering_time *= 2.0;
  add("lowered_on_a_plane").test.descent = studies::Descent::kOnPlane;
  add("without_hysteresis").fabric.bending_hysteresis.reset();
  for (double factor : {0.5, 2.0}) {
    material::Fabric& changed = add(factor < 1.0 ? "half_the_shear" : "twice_the_shear").fabric;
    changed.shear.elastic = changed.shear.elastic.scaledBy(factor);
  }
  studies::DrapeTest& cusick = add("disc_300_on_180_mm").test;
  cusick.fabric_radius = 0.15, cusick.support_radius = 0.09;
  return cases;
}

std::vector<studies::DrapeOutcome> drapeAll(const char* fabric, const std::vector<Case>& cases) {
  std::vector<studies::DrapeOutcome> outcomes(cases.size());
  linear::ThreadPool(kThreads).run(static_cast<int>(cases.size()), [&](int i, int /*thread*/) {
    const Case& of = cases[i];
    const studies::DrapeOutcome outcome = studies::drape(of.fabric, of.test, of.seed);
    std::cerr << std::string(fabric) + ' ' + of.name + ": drape coefficient " +
                     std::to_string(100.0 * outcome.coefficient) + " %, " +
                     std::to_string(outcome.nodes) + " folds, " +
                     std::to_string(1e3 * outcome.energy) + " mJ after " +
                     std::to_string(outcome.time) + " s at " +
                     std::to_string(1e3 * outcome.fastest) + " mm/s, " +
                     std::to_string(outcome.inside_support) + " particles in the support\n";
    outcomes[i] = outcome;
  });
  return outcomes;
}

void run(const Measured& measured, std::ostream* csv) {
  const material::Fabric fabric = material::loadFabric(
      std::string(HAPTEX_CONFIG_DIRECTORY "/fabrics/") + measured.file + ".yaml");
  const std::vector<Case> cases = casesOf(fabric);
  const std::vector<studies::DrapeOutcome> outcomes = drapeAll(measured.file, cases);
  if (csv) writeShape(measured.file, outcomes[0].shape, *csv);

  double mean = 0.0, square = 0.0;
  std::vector<double> nodes;
  int inside = 0;
  for (int i = 0; i < kStarts; ++i) {
    const double coefficient = 100.0 * outcomes[i].coefficient;
    mean += coefficient / kStarts;
    square += coefficient * coefficient / kStarts;
    nodes.push_back(outcomes[i].nodes);
  }
  std::sort(nodes.begin(), nodes.end());
  for (const studies::DrapeOutcome& outcome : outcomes) {
    inside = std::max(inside, outcome.inside_support);
  }
  const std::string name = std::string("drape/") + measured.file;
  bench::printLine(name + "/coefficient", mean, "%");
  bench::printLine(name + "/spread", std::sqrt(std::max(0.0, square - mean * mean)), "%");
  bench::printLine(name + "/folds", 0.5 * (nodes[(kStarts - 1) / 2] + nodes[kStarts / 2]), "1");
  bench::printLine(name + "/measured", measured.coefficient, "%");
  bench::printLine(name + "/folds_measured", measured.nodes, "1");
  bench::printLine(name + "/inside_support_most", inside, "1");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (i != 0 && i < kStarts) continue;
    bench::printLine(name + "/coefficient/" + cases[i].name, 100.0 * outcomes[i].coefficient, "%");
    bench::printLine(name + "/folds/" + cases[i].name, outcomes[i].nodes, "1");
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::ofstream csv;
  if (argc > 1) {
    csv.open(argv[1]);
    csv << "fabric,triangle,x,y,z\n";
    if (!csv) {
      std::cerr << "bench_drape: cannot write " << argv[1] << '\n';
      return 1;
    }
  }
  for (const Measured& measured : kMeasured) run(measured, argc > 1 ? &csv : nullptr);
  return 0;
}
