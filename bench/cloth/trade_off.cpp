// What does accuracy cost? Five motions of three fabrics, computed in many ways (elasticity,
// integrator, time step, resolution, solver, tolerance, thickness) beside converged references:
// errors in position, force and energy, and computing time. docs/trade_off.md defines all of it.
//
// bench_trade_off [CSV [DIRECTORY]] prints a line per motion, fabric, point and measure, shows its
// progress on standard error, and writes the table, to build/trade_off.csv if not told. Only with a
// DIRECTORY, config/presets for scripts/update_presets, it writes the presets there.
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/studies/quality_choice.h"
#include "haptex/studies/trade_off_study.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using cloth::Elasticity;
using cloth::IntegrationMethod;
using linear::LinearSolverMethod;
using studies::TradeOffPoint;

constexpr int kThreads = 2;
constexpr std::array kPresets = {"fast", "balanced", "accurate"};
constexpr double kMaxCost = 3.0;  // computing time over simulated time, beyond which nobody goes

TradeOffPoint pointOf(IntegrationMethod method, int cells, int steps_per_cycle, int solves) {
  TradeOffPoint point;
  point.step.method = method;
  point.step.newton_iterations = solves;
  point.cells = cells;
  point.steps_per_cycle = steps_per_cycle;
  return point;
}

/// Whose steps end by an error, with as many solves as that takes.
TradeOffPoint pointTo(double error, IntegrationMethod method, int cells, int steps_per_cycle) {
  TradeOffPoint point = pointOf(method, cells, steps_per_cycle, 20);
  point.step.newton_error = error;
  return point;
}

/// Implicit methods with Green-Lagrange elements: every resolution with every step.
void addGrid(std::vector<TradeOffPoint>& points) {
  for (int cells : {16, 12}) {
    for (int steps : {4, 2, 1}) {
      for (int solves : {1, 2, 3}) {
        points.push_back(pointOf(IntegrationMethod::kBackwardEuler, cells, steps, solves));
      }
      points.push_back(pointOf(IntegrationMethod::kBackwardMidpoint, cells, steps, 2));
      for (IntegrationMethod method : {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBdf2,
                                       IntegrationMethod::kTrBdf2}) {
        points.push_back(pointTo(1e-2, method, cells, steps));
      }
    }
  }
  for (IntegrationMethod method : {IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    for (double error : {1e-1, 1e-3}) points.push_back(pointTo(error, method, 16, 1));
  }
  points.push_back(pointOf(IntegrationMethod::kBackwardEuler, 8, 1, 2));
}

/// So fine that swings are right to a millimetre: followed as far as that is worth its time.
void addFine(std::vector<TradeOffPoint>& points) {
  for (int cells : {24, 20}) {
    for (int steps : {2, 1}) {
      points.push_back(pointTo(1e-2, IntegrationMethod::kTrBdf2, cells, steps));
    }
  }
}

/// Tolerances and solvers, which is precision, too: automatic preconditions by a factor in single
/// precision, the others compute in double precision.
void addSolvers(std::vector<TradeOffPoint>& points) {
  const TradeOffPoint base = pointOf(IntegrationMethod::kBackwardEuler, 16, 1, 2);
  for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-10}) {
    points.push_back(base);
    points.back().step.tolerance = tolerance;
  }
  for (LinearSolverMethod solver :
       {LinearSolverMethod::kCholesky, LinearSolverMethod::kConjugateGradient}) {
    points.push_back(base);
    points.back().step.solver = solver;
  }
}

void addModels(std::vector<TradeOffPoint>& points) {
  for (Elasticity elasticity : {Elasticity::kMassSpring, Elasticity::kCorotational}) {
    for (int cells : {16, 8}) {
      for (int steps : {4, 1}) {
        points.push_back(pointOf(IntegrationMethod::kBackwardEuler, cells, steps, 2));
        points.back().elasticity = elasticity;
      }
    }
  }
}

/// With the coarsest mesh, and steps of 0.39 and 0.1 ms.
void addExplicit(std::vector<TradeOffPoint>& points) {
  for (IntegrationMethod method :
       {IntegrationMethod::kExplicitEuler, IntegrationMethod::kExplicitMidpoint,
        IntegrationMethod::kRungeKutta4, IntegrationMethod::kTwoStepEuler}) {
    for (int steps : {32, 128}) points.push_back(pointOf(method, 8, steps, 1));
  }
}

/// Of the thicknesses at which layers meet.
void addThicknesses(std::vector<TradeOffPoint>& points) {
  for (double thickness : {0.5, 2.0, 4.0}) {
    points.push_back(pointTo(1e-2, IntegrationMethod::kBdf2, 16, 1));
    points.back().thickness = thickness;
    points.push_back(pointTo(1e-2, IntegrationMethod::kBdf2, 16, 4));
    points.back().thickness = thickness;
  }
}

std::vector<TradeOffPoint> allPoints() {
  std::vector<TradeOffPoint> points;
  addFine(points);  // those that take long first
  addThicknesses(points);
  addSolvers(points);
  addModels(points);
  addGrid(points);
  addExplicit(points);
  return points;
}

std::vector<studies::TradeOffCase> allCases() {
  std::vector<studies::TradeOffCase> cases;
  for (studies::Motion motion :
       {studies::Motion::kSwing, studies::Motion::kStretch, studies::Motion::kHang,
        studies::Motion::kDrape, studies::Motion::kFold}) {
    for (const char* fabric : {"linear", "wool", "acrylic_knit"}) {
      cases.push_back({motion, material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) +
                                                    "/fabrics/" + fabric + ".yaml")});
    }
  }
  return cases;
}

void printTable(const studies::TradeOffTable& table) {
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    const std::string of = std::string("trade_off/") + nameOf(table.cases[i].motion) + "/" +
                           table.cases[i].fabric.name + "/";
    const studies::TradeOffErrors& own = table.references[i].own_error;
    bench::printLine(of + "reference/position_error", own.position, "m");
    bench::printLine(of + "reference/force_error", own.force, "N");
    bench::printLine(of + "reference/energy_error", own.energy, "J");
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      const studies::TradeOffResult& result = table.results[k][i];
      if (!result.followed) continue;
      const std::string name = of + nameOf(table.points[k]);
      bench::printLine(name + "/position_error", result.error.position, "m");
      bench::printLine(name + "/force_error", result.error.force, "N");
      bench::printLine(name + "/energy_error", result.error.energy, "J");
      bench::printLine(name + "/cost", 1e3 * result.cost, "ms/s");
      bench::printLine(name + "/solves_per_step", result.solves_per_step, "1");
      bench::printLine(name + "/stable", result.stable, "1");
    }
  }
}

/// Those of every fabric, of its own motions.
void printPresets(const std::vector<scene::Quality>& qualities) {
  for (const scene::Quality& quality : qualities) {
    if (std::find(kPresets.begin(), kPresets.end(), quality.name) == kPresets.end()) continue;
    for (const scene::MeasuredQuality& measured : quality.measured) {
      if (measured.fabric != quality.fabric) continue;
      const std::string name =
          "trade_off/presets/" + quality.fabric + "/" + quality.name + "/" + measured.motion;
      bench::printLine(name + "/position_error", measured.position_error, "m");
      bench::printLine(name + "/cost", 1e3 * measured.cost, "ms/s");
    }
  }
}

/// The processor as the kernel calls it, or "unknown".
std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

/// Counts what is done on standard error.
studies::Progress counter(std::size_t of) {
  return [of, done = std::size_t{0}](const std::string& what) mutable {
    std::fprintf(stderr, "%zu of %zu: %s\n", ++done, of, what.c_str());
  };
}

bool writePresets(const std::string& directory, const std::vector<scene::Quality>& qualities) {
  const auto write = [&](const std::string& name, const std::vector<scene::Quality>& content) {
    std::ofstream file(directory + "/" + name + ".yaml");
    studies::writeQualities(file, content, machine());
    return static_cast<bool>(file.flush());
  };
  bool written = write("front", qualities);
  for (const std::string name : kPresets) {
    std::vector<scene::Quality> preset;  // one for every fabric
    std::copy_if(qualities.begin(), qualities.end(), std::back_inserter(preset),
                 [&](const scene::Quality& quality) { return quality.name == name; });
    written = write(name, preset) && written;
  }
  return written;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 3) {
    std::fprintf(stderr, "usage: bench_trade_off [CSV [DIRECTORY]]\n");
    return 1;
  }
  const std::string path = argc > 1 ? argv[1] : HAPTEX_CONFIG_DIRECTORY "/../build/trade_off.csv";
  studies::TradeOffTable table;
  table.cases = allCases();
  table.points = allPoints();
  table.references = computeReferences(table.cases, {}, kThreads, counter(2 * table.cases.size()));
  table.results = followPoints(table.points, table.cases, table.references, kMaxCost, kThreads,
                               counter(table.points.size()));
  const std::vector<scene::Quality> qualities = chooseQualities(table);
  printTable(table);
  printPresets(qualities);
  std::ofstream csv(path);
  writeTable(csv, table, qualities);
  if (!csv.flush()) {
    std::fprintf(stderr, "bench_trade_off: cannot write %s\n", path.c_str());
    return 1;
  }
  if (argc > 2 && !writePresets(argv[2], qualities)) {
    std::fprintf(stderr, "bench_trade_off: cannot write to %s\n", argv[2]);
    return 1;
  }
  return 0;
}
