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
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "haptex/cloth/cloth.h"
#include "haptex/cloth/integrator.h"
#include "haptex/material/fabric_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr double kTimeStep = 0.0125;  // s
constexpr double kFreeMotion = 2.0;   // s, then the sheet starts again
constexpr double kTolerance = 1e-6;
constexpr int kStepsPerCase = 320;

std::map<std::string, double> mean_step;  // ms, by "<case>/<triangles>"

std::size_t allocatedBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

cloth::ClothMesh horizontalSheet(int cells) {
  cloth::ClothMesh mesh =
      cloth::makeRectangle(0.5, 0.5, cells, cells, cloth::Triangulation::kAlternating);
  for (Eigen::Vector3d& position : mesh.initial_positions) {
    position = {position.z(), position.y(), 0.0};
  }
  return mesh;
}

void clothStep(benchmark::State& run, const std::string& name_of_case,
               const material::Fabric& fabric, int solves, int cells) {
  cloth::ModelledEffects effects;
  effects.viscosity = !fabric.weft.viscous.isZero();
  effects.gravity = {0.0, 0.0, -9.80665};
  const std::size_t before = allocatedBytes();
  cloth::Cloth cloth(horizontalSheet(cells), fabric, effects);
  cloth::ClothState state = cloth.initialState();
  const cloth::ClothState start = state;
  for (int particle : sideParticles(cloth.mesh(), cloth::Side::kTop)) {
    cloth::AttachmentPath place;
    place.start = state.positions[particle];
    cloth.attach(particle, place);
  }
  cloth::StepSettings settings;
  settings.tolerance = kTolerance;
  settings.newton_iterations = solves;
  cloth::Integrator integrator(cloth, settings);
  const double bytes = static_cast<double>(allocatedBytes() - before);

  double assembly = 0.0, solve = 0.0, total = 0.0, direct = 0.0, linear_solves = 0.0;
  for (auto _ : run) {
    if (state.time >= kFreeMotion) state = start;
    const cloth::StepReport report = integrator.step(cloth, state, kTimeStep);
    if (!report.accepted || !report.linear_converged) {
      run.SkipWithError("a step did not reach its tolerance");
      break;
    }
    run.SetIterationTime(report.total_seconds);
    assembly += report.assembly_seconds;
    solve += report.solve_seconds;
    total += report.total_seconds;
    linear_solves += report.newton_iterations;
    direct += report.solver == cloth::LinearSolverMethod::kCholesky;
  }
  const std::string triangles = std::to_string(cloth.mesh().triangles.size());
  const auto name = [&](const char* what) {
    return "cloth_step/" + name_of_case + what + "/" + triangles;
  };
  const double steps = static_cast<double>(run.iterations());
  mean_step[name_of_case + "/" + triangles] = 1e3 * total / steps;
  using bench::printLine;
  printLine(name("_rate"), steps / total, "Hz");
  printLine(name("_assembly_share"), 100.0 * assembly / total, "%");
  printLine(name("_solve_share"), 100.0 * solve / total, "%");
  printLine(name("_rest_share"), 100.0 * (total - assembly - solve) / total, "%");
  printLine(name("_factorised_steps"), 100.0 * direct / steps, "%");
  printLine(name("_solves"), linear_solves / steps, "per_step");
  printLine(name("_memory"), bytes / cloth.mesh().triangles.size(), "B/triangle");
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

cloth::StepSettings settingsOf(const Target& target) {
  cloth::StepSettings settings;
  settings.tolerance = kTargetTolerance;
  settings.threads = target.threads;
  return settings;
}

material::Fabric fabricOf(const Target& target, material::Fabric fabric) {
  using material::StrainStressCurve;
  fabric.weft.elastic = fabric.warp.elastic = StrainStressCurve::linear(target.stiffness);
  fabric.shear.elastic = StrainStressCurve::linear(0.5 * target.stiffness);
  return fabric;
}

/// Mean time of a step (ms), in the fastest of the runs.
double measureTarget(const Target& target, const material::Fabric& linear) {
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -9.80665};
  double fastest = std::numeric_limits<double>::infinity();
  for (int run = 0; run < target.runs; ++run) {
    cloth::Cloth cloth(horizontalSheet(target.cells), fabricOf(target, linear), effects);
    cloth::ClothState state = cloth.initialState();
    for (int particle : sideParticles(cloth.mesh(), cloth::Side::kTop)) {
      cloth::AttachmentPath place;
      place.start = state.positions[particle];
      cloth.attach(particle, place);
    }
    cloth::Integrator integrator(cloth, settingsOf(target));
    double total = 0.0;
    for (int step = 0; step < target.steps; ++step) {
      const cloth::StepReport report = integrator.step(cloth, state, target.time_step);
      if (!report.accepted || !report.linear_converged) return 0.0;
      total += report.total_seconds;
    }
    fastest = std::min(fastest, 1e3 * total / target.steps);
  }
  return fastest;
}

int runTargets(const material::Fabric& linear) {
  std::map<int, std::map<int, double>> times;  // ms, by threads and cells, of 12.5 ms steps
  bool failed = false;
  const auto measure = [&](const Target& target) {
    const double time = measureTarget(target, linear);
    const std::string triangles = std::to_string(2 * target.cells * target.cells);
    char name[80];
    std::snprintf(name, sizeof(name), "k%g_h%g%s", target.stiffness, 1e3 * target.time_step,
                  target.threads > 1 ? ("_threads" + std::to_string(target.threads)).c_str() : "");
    if (time == 0.0) {
      std::fprintf(stderr, "%s/%s: a step did not reach its tolerance\n", name, triangles.c_str());
      failed = true;
      return;
    }
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
  return failed ? 1 : 0;
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
  const int result = bench::runAll(argc, argv);
  for (int count : cells) {
    const std::string triangles = std::to_string(2 * count * count);
    const double wool_step = mean_step["wool/" + triangles];
    for (const char* other : {"linear", "wool_lines"}) {
      const double step = mean_step[other + ("/" + triangles)];
      if (step <= 0.0 || wool_step <= 0.0) continue;
      bench::printLine(std::string("cloth_step/wool_over_") + other + "/" + triangles,
                       wool_step / step, "ratio");
    }
  }
  return std::max(result, runTargets(linear));
}
