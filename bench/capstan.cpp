// Does friction on obstacles keep to Coulomb's law? A strip is drawn over a capsule in cases that are
// drawn at random from the ranges below: the ratio of the tensions at its ends against the capstan
// equation, and how much of the limit mu N friction has used, all contacts together and the worst
// particle. Without arguments 40 cases of seed 1 with two solves;
//   bench_capstan [--cases N] [--seed S] [--solves N] [--only CASE]
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>

#include "haptex/base/repeatable_random.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/experiments/capstan.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr double kStiffest = 16448.0;  // N/m, initial slope of wool's warp

material::Fabric drawFabric(base::RepeatableRandom& random, std::string& name) {
  const int kind = random.below(4);
  const double modulus = random.logarithmic(100.0, kStiffest);
  if (kind < 2) {
    name = "linear_" + std::to_string(std::lround(modulus));
    return material::linearFabric(modulus, 1e-3 * modulus);
  }
  material::Fabric wool = material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  name = kind == 2 ? "wool_weft" : "wool_warp";
  if (kind == 3) std::swap(wool.weft, wool.warp);
  return wool;
}

struct Spread {
  int cases = 0, within_1 = 0, within_5 = 0;
  double worst = 0.0, total = 0.0, particle = 0.0, pull = 0.0;
};

void runCase(int number, const std::string& fabric, const oracles::CapstanCase& capstan,
             Spread& spread) {
  const oracles::CapstanOutcome outcome = oracles::pullOverCapstan(capstan);
  const double error = outcome.ratio / outcome.exact - 1.0;
  std::cerr << number << ' ' << fabric << " mu " << capstan.friction << " wrap "
            << capstan.wrap * 180.0 / M_PI << " step " << 1e3 * capstan.time_step << " ms speed "
            << 1e3 * capstan.speed << " mm/s cell " << 1e3 * capstan.cell << " mm: ratio "
            << outcome.ratio << " exact " << outcome.exact << " error " << 100.0 * error
            << " % total " << outcome.total << " particle " << outcome.particle << " pull "
            << outcome.pull << " rounds " << outcome.rounds << " contacts " << outcome.contacts
            << " ms/step " << 1e3 * outcome.seconds << std::endl;
  ++spread.cases;
  spread.within_1 += std::abs(error) <= 0.01;
  spread.within_5 += std::abs(error) <= 0.05;
  spread.worst = std::max(spread.worst, std::abs(error));
  spread.total = std::max(spread.total, outcome.total);
  spread.particle = std::max(spread.particle, outcome.particle);
  spread.pull = std::max(spread.pull, outcome.pull);
}

int argument(int argc, char** argv, const std::string& name, int otherwise) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (argv[i] == name) return std::atoi(argv[i + 1]);
  }
  return otherwise;
}

}  // namespace

int main(int argc, char** argv) {
  const int cases = argument(argc, argv, "--cases", 40);
  const int only = argument(argc, argv, "--only", -1);
  base::RepeatableRandom random(argument(argc, argv, "--seed", 1));
  Spread spread;
  for (int number = 0; number < cases; ++number) {
    oracles::CapstanCase capstan;
    std::string fabric;
    capstan.fabric = drawFabric(random, fabric);
    capstan.friction = random.uniform(0.1, 0.7);
    capstan.wrap = random.uniform(0.5 * M_PI, 2.0 * M_PI);
    capstan.time_step = random.logarithmic(1e-3, 12.5e-3);
    capstan.speed = random.logarithmic(1e-3, 0.1);
    capstan.cell = random.logarithmic(1e-3, 1e-2);
    capstan.radius = oracles::capstanRadius(capstan.cell);
    capstan.solves = argument(argc, argv, "--solves", 2);
    capstan.steps = argument(argc, argv, "--steps", 200);
    if (only < 0 || only == number) runCase(number, fabric, capstan, spread);
  }
  const std::string name = "capstan/";
  bench::printLine(name + "cases", spread.cases, "1");
  bench::printLine(name + "within_1_percent", spread.within_1, "1");
  bench::printLine(name + "within_5_percent", spread.within_5, "1");
  bench::printLine(name + "worst", 100.0 * spread.worst, "%");
  bench::printLine(name + "total_over_limit", spread.total, "1");
  bench::printLine(name + "particle_over_limit", spread.particle, "1");
  bench::printLine(name + "pull", spread.pull, "N");
}
