// How much of its energy does a swinging sheet keep under each integrator? The linear reference
// hangs 0.359 m long from a bar and swings once a second, 50 mm to either side, without viscosity
// and air: its energy is constant. Implicit methods take 12.5 ms steps with two solves per stage,
// explicit ones a step of their own, short against the fastest vibration of the mesh (about 1 ms).
// No step is short enough for explicit Euler, which feeds every vibration; the explicit midpoint
// rule feeds them, too, but by the fourth power of step over period.
//
// bench_energy prints what is left per period, bench_energy CSV also writes the curves, which
// scripts/plot_energy draws: method, step (s), time (s), energy relative to that at the beginning.
#include <cmath>
#include <fstream>
#include <string>

#include "haptex/cloth/dynamics/step.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/cloth_swing.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr double kPeriod = 1.0;  // s
constexpr int kPeriods = 5;
constexpr double kSample = 0.0125;  // s, between points of a curve
constexpr double kMost = 10.0;      // of the first energy: what gains more is not followed

int stepsPerSample(cloth::IntegrationMethod method) {
  switch (method) {
    case cloth::IntegrationMethod::kExplicitEuler:
      return 6250;  // 2 us
    case cloth::IntegrationMethod::kExplicitMidpoint:
      return 1250;  // 10 us
    case cloth::IntegrationMethod::kRungeKutta4:
    case cloth::IntegrationMethod::kTwoStepEuler:
      return 50;  // 0.25 ms
    default:
      return 1;
  }
}

int periodsOf(cloth::IntegrationMethod method) {
  return method == cloth::IntegrationMethod::kExplicitEuler ? 1 : kPeriods;
}

/// Energies at the beginning and after each sample, relative to the first, as far as they go.
std::vector<double> curveOf(const oracles::ClothSwing& swing, cloth::IntegrationMethod method) {
  cloth::StepSettings settings;
  settings.method = method;
  settings.solver = linear::LinearSolverMethod::kCholesky;
  settings.newton_iterations = 2;
  const int per_sample = stepsPerSample(method);
  const int samples = static_cast<int>(std::lround(periodsOf(method) * kPeriod / kSample));
  const oracles::ClothSwing::Motion motion =
      swing.swing(settings, periodsOf(method) * kPeriod, samples * per_sample);
  std::vector<double> curve;
  for (int i = 0; i <= samples; ++i) {
    const double energy = motion.energies[i * per_sample] / motion.energies.front();
    if (!(energy <= kMost)) break;
    curve.push_back(energy);
  }
  return curve;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    std::fprintf(stderr, "usage: bench_energy [CSV]\n");
    return 1;
  }
  std::ofstream csv;
  if (argc == 2) {
    csv.open(argv[1]);
    csv << "method,step,time,energy\n";
    csv.precision(9);
  }
  const oracles::ClothSwing swing(
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml"), 32, 0.05);
  const std::string triangles = std::to_string(swing.cloth().mesh().triangles.size());
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    const std::vector<double> curve = curveOf(swing, named.method);
    const double seconds = (curve.size() - 1) * kSample;
    const double step = kSample / stepsPerSample(named.method);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      csv << named.name << ',' << step << ',' << i * kSample << ',' << curve[i] << '\n';
    }
    const std::string name = std::string("energy/") + named.name;
    bench::printLine(name + "_step/" + triangles, 1e3 * step, "ms");
    const int periods = periodsOf(named.method);
    if (seconds < (periods - 0.5) * kPeriod) {
      bench::printLine(name + "_tenfold_after/" + triangles, seconds, "s");
    } else {
      bench::printLine(name + "_kept_per_period/" + triangles,
                       100.0 * std::pow(curve.back(), 1.0 / periods), "%");
    }
  }
  if (argc == 2 && !csv.flush()) {
    std::fprintf(stderr, "bench_energy: cannot write %s\n", argv[1]);
    return 1;
  }
  return 0;
}
