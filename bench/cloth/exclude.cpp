// By how much does a step take less time when a part of the cloth is left out of the computation?
// A corner of the shipped sample of wool is moved; of its particles the lower rows are excluded.
// Per share of particles that are excluded and number of triangles of the whole:
//   exclude/<percent>/<triangles>        computing time of a step
//   exclude/<percent>/<triangles>/ratio  over that of the whole, in turns with it
//   exclude/<percent>/<triangles>/change computing time of excluding and including that part
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/simulated_cloth.h"
#include "haptex/simulation/step_cost.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using simulation::SimulatedCloth;

constexpr int kRounds = 9;
constexpr int kSteps = 16;

/// s per step of the next kSteps.
double stepSeconds(SimulatedCloth& simulation) {
  const double begin = simulation::threadSeconds();
  for (int i = 0; i < kSteps; ++i) simulation.step();
  return (simulation::threadSeconds() - begin) / kSteps;
}

/// Its upper right corner moves all the time, so that no step is slept through.
SimulatedCloth movedSample(double cell) {
  const std::string path = HAPTEX_CONFIG_DIRECTORY "/scenes/wool_sample.yaml";
  const scene::Scene scene = scene::loadScene(path, cell);
  SimulatedCloth simulation(scene, scene::loadSceneFabrics(path, scene));
  simulation.move({static_cast<std::uint32_t>(scene.attached_particles.back())}, {0.0, 0.0, 0.02},
                  100.0);
  return simulation;
}

void printShare(int percent, double cell) {
  SimulatedCloth whole = movedSample(cell), part = movedSample(cell);
  const auto particles = static_cast<double>(part.cloth().particleCount());
  std::vector<std::uint32_t> lower(static_cast<std::size_t>(0.01 * percent * particles));
  std::iota(lower.begin(), lower.end(), 0u);
  double change = 0.0;
  if (!lower.empty()) {
    const double begin = simulation::threadSeconds();
    part.exclude(lower);
    part.include({});
    change = simulation::threadSeconds() - begin;
    part.exclude(lower);
  }
  double shortest = std::numeric_limits<double>::infinity();
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    const double of_part = stepSeconds(part);
    shortest = std::min(shortest, of_part);
    ratios.push_back(of_part / stepSeconds(whole));
  }
  std::nth_element(ratios.begin(), ratios.begin() + kRounds / 2, ratios.end());
  const std::string name = "exclude/" + std::to_string(percent) + "/" +
                           std::to_string(part.cloth().mesh().triangles.size());
  bench::printLine(name, 1e3 * shortest, "ms");
  bench::printLine(name + "/ratio", ratios[kRounds / 2], "1");
  if (change > 0.0) bench::printLine(name + "/change", 1e3 * change, "ms");
}

}  // namespace

int main() {
  for (const double cell : {0.2 / 32, 0.2 / 64}) {
    for (const int percent : {0, 25, 50, 75, 90}) printShare(percent, cell);
  }
  return 0;
}
