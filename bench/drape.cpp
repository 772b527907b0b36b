// Drape of two fabrics whose drape was measured: drape coefficient and number of folds over several
// starts, beside what was measured. bench_drape CSV also writes the first draped shape of each
// fabric for scripts/plot_drape.
//
// Measured: Matsudaira, Masuda, Wada, Yokura 2015, J. Textile Eng. 61(6):69-73, as transcribed in
// the public repository antonbj3/3fold-motion-engine. The diameters of fabric and support are not
// in the transcription: 254 mm on 127 mm is the usual pair for this apparatus.
#include "haptex/studies/drape.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

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
constexpr int kSeeds = 6;

void writeShape(const char* fabric, const mesh::ClothMesh& shape, std::ostream& csv) {
  for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
    for (const int particle : shape.triangles[i]) {
      const Eigen::Vector3d& place = shape.initial_positions[particle];
      csv << fabric << ',' << i << ',' << place.x() << ',' << place.y() << ',' << place.z() << '\n';
    }
  }
}

void printSpread(const std::string& name, const std::string& triangles, std::vector<double> values,
                 const char* unit) {
  std::sort(values.begin(), values.end());
  double mean = 0.0;
  for (double value : values) mean += value / static_cast<double>(values.size());
  bench::printLine(name + "_mean" + triangles, mean, unit);
  bench::printLine(name + "_least" + triangles, values.front(), unit);
  bench::printLine(name + "_most" + triangles, values.back(), unit);
}

void run(const Measured& measured, std::ostream* csv) {
  const material::Fabric fabric = material::loadFabric(
      std::string(HAPTEX_CONFIG_DIRECTORY "/fabrics/") + measured.file + ".yaml");
  const std::string name = std::string("drape/") + measured.file;
  std::vector<double> coefficients, nodes;
  std::string triangles;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const studies::DrapeOutcome outcome = studies::drape(fabric, {}, seed);
    triangles = "/" + std::to_string(outcome.shape.triangles.size());
    std::cerr << measured.file << " start " << seed << " of " << kSeeds << ": drape coefficient "
              << 100.0 * outcome.coefficient << " %, " << outcome.nodes << " nodes, after "
              << outcome.time << " s at " << 1e3 * outcome.fastest << " mm/s, "
              << outcome.inside_support << " particles inside of the support\n";
    coefficients.push_back(100.0 * outcome.coefficient);
    nodes.push_back(outcome.nodes);
    if (csv && seed == 1) writeShape(measured.file, outcome.shape, *csv);
  }
  bench::printLine(name + "_coefficient_measured" + triangles, measured.coefficient, "%");
  printSpread(name + "_coefficient", triangles, coefficients, "%");
  bench::printLine(name + "_nodes_measured" + triangles, measured.nodes, "1");
  printSpread(name + "_nodes", triangles, nodes, "1");
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
