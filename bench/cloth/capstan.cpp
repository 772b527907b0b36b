// Does friction on obstacles keep to Coulomb's law? A strip is drawn over a capsule in cases that
// are drawn at random from the ranges below: the ratio of the tensions at its ends against the
// capstan equation, and how much of the limit mu N friction has used, all contacts together and the
// worst particle. Without arguments 40 cases of seed 1 with two solves;
//   bench_capstan [--cases N] [--seed S] [--solves N] [--steps N] [--only CASE]
#include "haptex/oracles/experiments/capstan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

#include "haptex/base/repeatable_random.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

struct Spread {
  int cases = 0, within_1 = 0, within_5 = 0;
  double worst = 0.0, total = 0.0, particle = 0.0, pull = 0.0;
};

void runCase(int number, const oracles::CapstanCase& capstan, Spread& spread) {
  const oracles::CapstanOutcome outcome = oracles::pullOverCapstan(capstan);
  const double error = outcome.ratio / outcome.exact - 1.0;
  std::cerr << number << ' ' << capstan.fabric.name << " mu " << capstan.friction << " wrap "
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
    oracles::CapstanCase capstan = oracles::drawCapstan(HAPTEX_CONFIG_DIRECTORY, random);
    capstan.solves = argument(argc, argv, "--solves", 2);
    capstan.steps = argument(argc, argv, "--steps", 200);
    if (only < 0 || only == number) runCase(number, capstan, spread);
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
