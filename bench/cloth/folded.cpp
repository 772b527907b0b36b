// Does the cost of a step depend on how the cloth lies? A sample like the shipped one is gripped
// near its lower edge, or at a lower corner, and lifted, held, shaken, held again, pulled and let
// go, so that much of it is compressed and folds. A second sheet that only hangs makes its steps in
// turns with it, so that what disturbs one disturbs the other. A run repeats exactly; of each step
// the shortest of kRuns times counts. Per fabric:
//   mean_ratio, p99_ratio       of a step of the gripped sheet over one of the hanging one, over
//                               all phases; <grip>/... the same of one grip
//   hanging_mean, hanging_p99, folded_mean, folded_p99    computing time of a step
//   hanging_solves, folded_solves                         linear solves of a step
//   <grip>/<phase>/mean, p99, solves, iterations, taken_anew    of a phase; iterations per solve
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/simulated_cloth.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Clock = std::chrono::steady_clock;
using Eigen::Vector3d;
using Particles = std::vector<std::uint32_t>;

constexpr int kRuns = 3;
constexpr int kColumns = 33;  // of particles, of the shipped sample
const std::string kScene = HAPTEX_CONFIG_DIRECTORY "/scenes/wool_sample.yaml";

struct Grip {
  const char* name;
  Particles particles;
};

Particles block(int first_row, int rows, int first_column, int columns) {
  Particles particles;
  for (int row = first_row; row < first_row + rows; ++row) {
    for (int i = 0; i < columns; ++i) {
      particles.push_back(static_cast<std::uint32_t>(row * kColumns + first_column + i));
    }
  }
  return particles;
}

struct Move {
  Vector3d displacement;  // m; the sheet hangs in the plane of y and z
  int steps;              // of the phase
  double duration;        // s
};

struct Phase {
  const char* name;
  std::vector<Move> moves;  // one after the other; none that moves nothing needs a grip
};

const std::vector<Phase>& phases() {
  static const std::vector<Phase> all_phases = {
      {"lifted", {{{0.0, 0.0, 0.03}, 40, 0.4}}},
      {"held", {{Vector3d::Zero(), 60, 0.0}}},
      {"shaken",
       {{{0.03, 0.0, 0.0}, 12, 0.12},
        {{-0.06, 0.0, 0.0}, 16, 0.18},
        {{0.06, 0.0, 0.0}, 16, 0.18},
        {{-0.03, 0.03, 0.0}, 12, 0.12},
        {{0.0, -0.06, 0.0}, 16, 0.18},
        {{0.0, 0.03, 0.0}, 12, 0.12}}},
      {"held_folded", {{Vector3d::Zero(), 60, 0.0}}},
      {"pulled", {{{0.06, 0.0, -0.02}, 40, 0.4}, {Vector3d::Zero(), 20, 0.0}}},
      {"let_go", {{Vector3d::Zero(), 80, 0.0}}},
  };
  return all_phases;
}

/// Of one step.
struct Sample {
  double seconds = std::numeric_limits<double>::infinity();
  int solves = 0;
  int iterations = 0;
  bool taken_anew = false;
};

double meanSeconds(const std::vector<Sample>& samples) {
  double sum = 0.0;
  for (const Sample& sample : samples) sum += sample.seconds;
  return sum / static_cast<double>(samples.size());
}

double p99Seconds(const std::vector<Sample>& samples) {
  std::vector<double> seconds;
  for (const Sample& sample : samples) seconds.push_back(sample.seconds);
  std::sort(seconds.begin(), seconds.end());
  const double place = std::ceil(0.99 * static_cast<double>(seconds.size())) - 1.0;
  return seconds[static_cast<std::size_t>(place)];
}

double meanSolves(const std::vector<Sample>& samples) {
  double sum = 0.0;
  for (const Sample& sample : samples) sum += sample.solves;
  return sum / static_cast<double>(samples.size());
}

void append(std::vector<Sample>& all, const std::vector<Sample>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Takes a step and keeps the shorter time of this and earlier runs.
void step(simulation::SimulatedCloth& sheet, Sample& sample) {
  const Clock::time_point begin = Clock::now();
  if (!sheet.step()) throw std::runtime_error("a step was rejected");
  const std::chrono::duration<double> took = Clock::now() - begin;
  const cloth::StepReport& report = sheet.lastReport();
  if (!report.linear_converged) throw std::runtime_error("a solve missed its tolerance");
  sample = {std::min(sample.seconds, took.count()), report.newton_iterations,
            report.linear_iterations, report.taken_anew};
}

/// The times of both sheets, phase by phase.
class Comparison {
 public:
  Comparison(const material::Fabric& fabric, const Grip& grip)
      : fabric_(fabric), grip_(grip), gripped_(phases().size()), hanging_(phases().size()) {}

  void run() {
    const scene::Scene scene = scene::loadScene(kScene);
    simulation::SimulatedCloth gripped(scene, fabric_), hanging(scene, fabric_);
    Sample start;
    for (int i = 0; i < 80; ++i) {
      step(gripped, start);
      step(hanging, start);
    }
    gripped.attach(grip_.particles);
    for (std::size_t p = 0; p < phases().size(); ++p) {
      if (p + 1 == phases().size()) gripped.release(grip_.particles);
      std::size_t at = 0;
      for (const Move& move : phases()[p].moves) {
        if (move.duration > 0.0) gripped.move(grip_.particles, move.displacement, move.duration);
        for (int i = 0; i < move.steps; ++i, ++at) {
          if (gripped_[p].size() <= at) {
            gripped_[p].emplace_back();
            hanging_[p].emplace_back();
          }
          stepAwake(gripped, gripped_[p][at]);
          stepAwake(hanging, hanging_[p][at]);
        }
      }
    }
  }

  void print(const std::string& name) const {
    const auto line = [&](const Phase& phase, const char* what, double value, const char* unit) {
      bench::printLine(name + grip_.name + "/" + phase.name + "/" + what, value, unit);
    };
    for (std::size_t p = 0; p < phases().size(); ++p) {
      double solves = 0.0, iterations = 0.0, anew = 0.0;
      for (const Sample& sample : gripped_[p]) {
        solves += sample.solves;
        iterations += sample.iterations;
        anew += sample.taken_anew ? 1.0 : 0.0;
      }
      line(phases()[p], "mean", 1e3 * meanSeconds(gripped_[p]), "ms");
      line(phases()[p], "p99", 1e3 * p99Seconds(gripped_[p]), "ms");
      line(phases()[p], "solves", meanSolves(gripped_[p]), "per_step");
      line(phases()[p], "iterations", iterations / solves, "per_solve");
      line(phases()[p], "taken_anew", anew, "steps");
    }
    bench::printLine(name + grip_.name + "/mean_ratio",
                     meanSeconds(gripped()) / meanSeconds(hanging()), "ratio");
    bench::printLine(name + grip_.name + "/p99_ratio",
                     p99Seconds(gripped()) / p99Seconds(hanging()), "ratio");
  }

  std::vector<Sample> gripped() const { return joined(gripped_); }
  std::vector<Sample> hanging() const { return joined(hanging_); }

 private:
  /// A sheet that has come to rest would only let the time pass.
  static void stepAwake(simulation::SimulatedCloth& sheet, Sample& sample) {
    if (sheet.asleep()) sheet.attach({kColumns * kColumns - 1});  // held there already
    step(sheet, sample);
  }

  static std::vector<Sample> joined(const std::vector<std::vector<Sample>>& parts) {
    std::vector<Sample> all;
    for (const std::vector<Sample>& part : parts) append(all, part);
    return all;
  }

  const material::Fabric& fabric_;
  const Grip& grip_;
  std::vector<std::vector<Sample>> gripped_, hanging_;  // by phase and step
};

void runBench(const std::string& name, const std::string& file) {
  static const std::vector<Grip> grips = {{"edge", block(2, 2, 15, 3)},
                                          {"corner", block(0, 2, 0, 3)}};
  const material::Fabric fabric =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + file + ".yaml");
  const std::string prefix = "folded/" + name + "/";
  std::vector<Sample> folded, hanging;
  for (const Grip& grip : grips) {
    Comparison comparison(fabric, grip);
    for (int run = 0; run < kRuns; ++run) comparison.run();
    comparison.print(prefix);
    append(folded, comparison.gripped());
    append(hanging, comparison.hanging());
  }
  const auto print_sheet = [&](const std::string& of, const std::vector<Sample>& samples) {
    bench::printLine(prefix + of + "_mean", 1e3 * meanSeconds(samples), "ms");
    bench::printLine(prefix + of + "_p99", 1e3 * p99Seconds(samples), "ms");
    bench::printLine(prefix + of + "_solves", meanSolves(samples), "per_step");
  };
  print_sheet("hanging", hanging);
  print_sheet("folded", folded);
  bench::printLine(prefix + "mean_ratio", meanSeconds(folded) / meanSeconds(hanging), "ratio");
  bench::printLine(prefix + "p99_ratio", p99Seconds(folded) / p99Seconds(hanging), "ratio");
}

}  // namespace

int main() {
  try {
    runBench("wool", "wool");
    runBench("denim", "denim");
    runBench("silk", "silk_habutae");
    runBench("linear", "linear");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
