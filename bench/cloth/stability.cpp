// How does cloth behave at the extremes?
//   bench_stability [--cases N] [--self_colliding N] [--seed S] [--maps CSV]
// Runs N generated cases (studies/extreme_case.h) on two threads, by default 50000 from seed 1,
// and then 1000 with cloth that collides with itself, those from seed 1 on that allow it.
// Prints how many failed and by how much the worst missed its rest state, all together and by
// kind. A failed case is shrunk, and printed on standard error as text that a test can take.
// Then the limits of the explicit integrators, as longest step times highest angular frequency,
// beside those of theory; and into the CSV what becomes of a vibrating sheet for each integrator,
// time step and stiffness, which scripts/plot_stability draws.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "haptex/studies/extreme_run.h"
#include "haptex/studies/extreme_shrink.h"
#include "haptex/studies/extreme_tally.h"
#include "haptex/studies/stability_map.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using studies::ExtremeCase;
using studies::ExtremeFailure;
using studies::ExtremeOutcome;

constexpr double kMapStiffness = 100.0;  // N/m, of the limits; they do not depend on it

struct Arguments {
  long cases = 50000;
  long self_colliding = 1000;
  std::uint64_t seed = 1;
  std::string maps;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string key = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(key + " lacks a value");
    if (key == "--cases") {
      arguments.cases = std::stol(argv[i + 1]);
    } else if (key == "--self_colliding") {
      arguments.self_colliding = std::stol(argv[i + 1]);
    } else if (key == "--seed") {
      arguments.seed = std::stoull(argv[i + 1]);
    } else if (key == "--maps") {
      arguments.maps = argv[i + 1];
    } else {
      throw std::invalid_argument("unknown argument " + key +
                                  "; --cases, --self_colliding, --seed, --maps");
    }
  }
  return arguments;
}

void printFailure(const ExtremeCase& extreme, const ExtremeOutcome& outcome) {
  std::fprintf(stderr, "seed %llu: %s %s, growth %g, return error %g, shrunk to\n  %s\n",
               static_cast<unsigned long long>(extreme.seed), nameOf(outcome.failure),
               outcome.message.c_str(), outcome.growth, outcome.return_error,
               toText(shrinkFailure(extreme, outcome)).c_str());
}

class Cases {
 public:
  /// @param name of the lines that are printed
  Cases(std::string name, std::vector<ExtremeCase> cases)
      : name_(std::move(name)), cases_(std::move(cases)) {}

  void run() {
    std::thread other([this] { work(); });
    work();
    other.join();
    tally_.print(name_, bench::printLine);
  }

 private:
  void work() {
    for (std::size_t i; (i = next_++) < cases_.size();) {
      const ExtremeOutcome outcome = studies::runExtremeCase(cases_[i]);
      add(cases_[i], outcome);
      if (outcome.failure != ExtremeFailure::kNone) printFailure(cases_[i], outcome);
    }
  }

  void add(const ExtremeCase& extreme, const ExtremeOutcome& outcome) {
    const std::lock_guard<std::mutex> lock(mutex_);
    tally_.add(extreme, outcome);
    const long done = tally_.cases();
    if (done % std::max<long>(1, static_cast<long>(cases_.size()) / 50) != 0) return;
    std::fprintf(stderr, "%s %ld of %zu cases, %ld failures\n", name_.c_str(), done, cases_.size(),
                 tally_.failures());
  }

  std::string name_;
  std::vector<ExtremeCase> cases_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  studies::ExtremeTally tally_;
};

std::vector<ExtremeCase> drawCases(const Arguments& arguments) {
  std::vector<ExtremeCase> cases;
  for (long i = 0; i < arguments.cases; ++i) {
    cases.push_back(studies::drawExtremeCase(arguments.seed + i));
  }
  return cases;
}

void printLimits() {
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    if (cloth::isImplicit(named.method)) continue;
    const studies::StabilityLimit limit = studies::findStabilityLimit(named.method, kMapStiffness);
    bench::printLine(std::string("stability/limit/") + named.name, limit.measured, "h_omega");
    bench::printLine(std::string("stability/limit_of_theory/") + named.name, limit.theory,
                     "h_omega");
  }
}

void writeMaps(const std::string& path) {
  constexpr int kStepsPerDecade = 4;
  constexpr int kStiffnessesPerDecade = 3;
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path);
  file << "method,time_step,stiffness,frequency,stability,energy_left\n";
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    std::fprintf(stderr, "map of %s\n", named.name);
    for (int k = -3 * kStiffnessesPerDecade; k <= 7 * kStiffnessesPerDecade; ++k) {
      const double stiffness = std::pow(10.0, static_cast<double>(k) / kStiffnessesPerDecade);
      const double frequency = studies::highestFrequency(stiffness);
      for (int s = -6 * kStepsPerDecade; s <= kStepsPerDecade; ++s) {
        const double time_step = std::pow(10.0, static_cast<double>(s) / kStepsPerDecade);
        const auto cell = studies::findStability(named.method, 1, time_step, stiffness);
        file << named.name << ',' << time_step << ',' << stiffness << ',' << frequency << ','
             << nameOf(cell.stability) << ',' << cell.energy_left << '\n';
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.cases > 0) Cases("stability/", drawCases(arguments)).run();
    if (arguments.self_colliding > 0) {
      Cases("stability/self_colliding/",
            studies::drawSelfCollidingCases(arguments.seed, arguments.self_colliding))
          .run();
    }
    printLimits();
    if (!arguments.maps.empty()) writeMaps(arguments.maps);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_stability: %s\n", error.what());
    return 1;
  }
  return 0;
}
