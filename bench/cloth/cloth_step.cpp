// How long does a step of the large-scale cloth take, where does the time go, and what memory does
// it hold? The sheet is that of the HAPTEX performance test of 2005: 0.5 m square, attached
// horizontally along one edge, moving freely under gravity; here for 2 s at 12.5 ms steps, solved
// to a relative residual of 1e-6 by whichever solver the automatic choice takes. "wool" has its
// viscosity, as its scene models it; "wool_lines" is wool whose curves go on as they begin: what
// curves cost by themselves; "wool_newton" is wool with a Newton iteration after the linearised
// step. "_solves" are the linear solves of a step: more than asked for where it was taken anew.
//
// The cases "target" are those that a step's time was promised for, to a relative residual of 1e-4
// and with the stiffness k (N/m), the time step h (ms) and the threads in their names. Of some runs
// of a second of the motion the fastest counts, so that other processes disturb less. "growth" is
// the exponent with which the time grows from 2048 to 100352 triangles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/simulation/step_cost.h"
#include "held_sheet.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using bench::HeldSheet;

constexpr double kTimeStep = 0.0125;  // s
constexpr double kTolerance = 1e-6;
constexpr int kStepsPerCase = 320;

cloth::StepSettings settingsOf(double tolerance, int solves = 1, int threads = 1) {
  cloth::StepSettings settings;
  settings.tolerance = tolerance;
  settings.newton_iterations = solves;
  settings.threads = threads;
  return settings;
}

void clothStep(benchmark::State& run, const std::string& name_of_case,
               const material::Fabric& fabric, int solves, int cells) {
  const std::size_t before = simulation::allocatedBytes();
  HeldSheet sheet(fabric, cells, settingsOf(kTolerance, solves));
  const double bytes = static_cast<double>(simulation::allocatedBytes() - before);

  double assembly = 0.0, solve = 0.0, total = 0.0, direct = 0.0, linear_solves = 0.0;
  for (auto _ : run) {
    const cloth::StepReport report = sheet.step(kTimeStep);
    run.SetIterationTime(report.total_seconds);
    assembly += report.assembly_seconds;
    solve += report.solve_seconds;
    total += report.total_seconds;
    linear_solves += report.newton_iterations;
    direct += report.solver == linear::LinearSolverMethod::kCholesky;
  }
  const std::string triangles = std::to_string(sheet.triangleCount());
  const auto name = [&](const char* what) {
    return "cloth_step/" + name_of_case + what + "/" + triangles;
  };
  const double steps = static_cast<double>(run.iterations());
  using bench::printLine;
  printLine(name("_rate"), steps / total, "Hz");
  printLine(name("_assembly_share"), 100.0 * assembly / total, "%");
  printLine(name("_solve_share"), 100.0 * solve / total, "%");
  printLine(name("_rest_share"), 100.0 * (total - assembly - solve) / total, "%");
  printLine(name("_factorised_steps"), 100.0 * direct / steps, "%");
  printLine(name("_solves"), linear_solves / steps, "per_step");
  printLine(name("_memory"), bytes / sheet.triangleCount(), "B/triangle");
}

/// The fabric with straight lines for curves, of the slopes at zero.
material::Fabric straightened(material::Fabric fabric) {
  for (material::MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    for (material::StrainStressCurve* curve : {&curves->elastic, &curves->viscous}) {
      *curve = material::StrainStressCurve::linear(curve->evaluate(0.0).slope);
    }
  }
  return fabric;
}

struct Target {
  int cells;
  double stiffness;  // N/m
  double time_step;  // s
  int threads;
  int steps;
  int runs;
};

constexpr double kTargetTolerance = 1e-4;

/// Mean time of a step (ms), in the fastest of the runs.
double measureTarget(const Target& target, const material::Fabric& linear) {
  double fastest = std::numeric_limits<double>::infinity();
  for (int run = 0; run < target.runs; ++run) {
    HeldSheet sheet(bench::withStiffness(linear, target.stiffness), target.cells,
                    settingsOf(kTargetTolerance, 1, target.threads));
    double total = 0.0;
    for (int step = 0; step < target.steps; ++step) {
      total += sheet.step(target.time_step).total_seconds;
    }
    fastest = std::min(fastest, 1e3 * total / target.steps);
  }
  return fastest;
}

void runTargets(const material::Fabric& linear) {
  std::map<int, std::map<int, double>> times;  // ms, by threads and cells, of 12.5 ms steps
  const auto measure = [&](const Target& target) {
    const double time = measureTarget(target, linear);
    const std::string triangles = std::to_string(2 * target.cells * target.cells);
    char name[80];
    std::snprintf(name, sizeof(name), "k%g_h%g%s", target.stiffness, 1e3 * target.time_step,
                  target.threads > 1 ? ("_threads" + std::to_string(target.threads)).c_str() : "");
    bench::printLine(std::string("cloth_step/target/") + name + "/" + triangles, time, "ms");
    bench::printLine(std::string("cloth_step/target/") + name + "_rate/" + triangles, 1e3 / time,
                     "Hz");
    if (target.time_step > 0.01) times[target.threads][target.cells] = time;
  };
  measure({32, 100.0, 0.001, 1, 1000, 3});
  for (int threads : {1, 2}) {
    measure({32, 1000.0, 0.0125, threads, 80, 5});
    measure({71, 1000.0, 0.0125, threads, 80, 3});
    measure({224, 1000.0, 0.0125, threads, 80, 2});
    const double ratio = times[threads][224] / times[threads][32];
    bench::printLine("cloth_step/target/growth_threads" + std::to_string(threads) + "/100352",
                     std::log(ratio) / std::log(100352.0 / 2048.0), "exponent");
  }
}

/// Sheets of all fabrics make their steps in turn, so that what disturbs one disturbs the others.
void compare(const material::Fabric& linear, const material::Fabric& wool, int cells) {
  const cloth::StepSettings settings = settingsOf(kTolerance);
  std::array<HeldSheet, 3> sheets{HeldSheet(linear, cells, settings),
                                  HeldSheet(wool, cells, settings),
                                  HeldSheet(straightened(wool), cells, settings)};
  std::array<double, 3> totals{};
  for (int step = 0; step < kStepsPerCase; ++step) {
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      totals[i] += sheets[i].step(kTimeStep).total_seconds;
    }
  }
  const std::string triangles = "/" + std::to_string(sheets[0].triangleCount());
  bench::printLine("cloth_step/wool_over_linear" + triangles, totals[1] / totals[0], "ratio");
  bench::printLine("cloth_step/wool_over_wool_lines" + triangles, totals[1] / totals[2], "ratio");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string fabrics = HAPTEX_CONFIG_DIRECTORY "/fabrics/";
  const material::Fabric linear = material::loadFabric(fabrics + "linear.yaml");
  const material::Fabric wool = material::loadFabric(fabrics + "wool.yaml");
  const int cells[] = {22, 32, 50, 71};  // 968, 2048, 5000, 10082 triangles
  const auto add = [&](const std::string& name, const material::Fabric& fabric, int solves) {
    for (int count : cells) {
      const std::string full = "cloth_step/" + name + "/" + std::to_string(2 * count * count);
      benchmark::RegisterBenchmark(full.c_str(), clothStep, name, fabric, solves, count)
          ->UseManualTime()
          ->Iterations(kStepsPerCase);
    }
  };
  add("linear", linear, 1);
  add("wool", wool, 1);
  add("wool_lines", straightened(wool), 1);
  add("wool_newton", wool, 2);
  try {
    const int result = bench::runAll(argc, argv);
    for (int count : cells) compare(linear, wool, count);
    runTargets(linear);
    return result;
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
