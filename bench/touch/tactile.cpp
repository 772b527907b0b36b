// Do two fingers' steps of 25 ms fit beside everything else (below 0.5 ms on one core), and what
// does a surface cost to build? The step is timed beside a Fourier transform of the same relief,
// which a renderer that keeps heights instead of waves would need in every step, and beside a copy
// of the waves, which is the least that reading them costs. Then the table of docs/results.md: how
// the shipped fabrics feel in the standard stroke, and weaves that differ in nothing else.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/oracles/experiments/standard_stroke.h"
#include "haptex/tactile/weave_relief.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using bench::printLine;
using material::Fabric;
using tactile::Surface;

constexpr int kSteps = 4000;

template <typename Call>
double millisecondsOf(const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

/// Prints median and 99th percentile of many calls. @returns the median, ms
template <typename Call>
double printTimes(const std::string& name, int calls, const Call& call) {
  std::vector<double> times;
  for (int i = 0; i < calls; ++i) times.push_back(millisecondsOf([&] { call(i); }));
  std::sort(times.begin(), times.end());
  printLine(name + "/median", times[calls / 2], "ms");
  printLine(name + "/p99", times[calls * 99 / 100], "ms");
  return times[calls / 2];
}

std::vector<Fabric> fabricsWithSurface() {
  std::vector<Fabric> fabrics;
  for (const auto& entry :
       std::filesystem::directory_iterator(HAPTEX_CONFIG_DIRECTORY "/fabrics")) {
    if (entry.path().extension() != ".yaml") continue;
    Fabric fabric = material::loadFabric(entry.path().string());
    if (fabric.surface) fabrics.push_back(std::move(fabric));
  }
  return fabrics;
}

/// One step of index and thumb, which wander over the fabric with all contactors on it.
void timeSteps(const std::string& name, const Surface& surface) {
  const tactile::KSpace& waves = surface.small_scale.waves;
  printLine(name + "/waves", static_cast<double>(waves.size()), "1");
  const double step = printTimes(name + "/two_fingers", kSteps, [&](int i) {
    for (int finger = 0; finger < 2; ++finger) {
      tactile::TouchedFabric touched;
      touched.stroke = {0.02 * oracles::direction(i + 90.0 * finger), 0.5};
      touched.placement.origin = Eigen::Vector2d(1e-4 * i, 0.01 * finger);
      touched.forces.fill(0.02);
      benchmark::DoNotOptimize(tactile::arrayAmplitudes(surface, touched, {}));
    }
  });
  std::vector<double> copy(waves.size());
  const double copying = printTimes(name + "/copy_of_waves_twice", kSteps, [&](int) {
    for (const auto* values :
         {&waves.weft, &waves.warp, &waves.power, &waves.weft, &waves.warp, &waves.power}) {
      std::memcpy(copy.data(), values->data(), values->size() * sizeof(double));
      benchmark::DoNotOptimize(copy.data());
      benchmark::ClobberMemory();
    }
  });
  printLine(name + "/two_fingers_over_copy", step / copying, "1");
}

}  // namespace

int main() {
  for (const Fabric& fabric : fabricsWithSurface()) {
    Surface surface;
    std::vector<double> times;
    for (int i = 0; i < 5; ++i) {
      times.push_back(millisecondsOf([&] { surface = tactile::buildSurface(fabric); }));
    }
    printLine("tactile/build/" + fabric.name, *std::min_element(times.begin(), times.end()), "ms");
    timeSteps("tactile/step/" + fabric.name, surface);
    if (const auto* weave = std::get_if<material::Weave>(&fabric.surface->relief)) {
      const tactile::HeightField relief = tactile::weaveRelief(*weave);
      printTimes("tactile/transform_twice/" + fabric.name, 100, [&](int) {
        for (int finger = 0; finger < 2; ++finger) {
          benchmark::DoNotOptimize(tactile::kSpaceOfPeriodic(relief));
        }
      });
    }
  }
  for (const auto& fabric : oracles::renderFabrics(HAPTEX_CONFIG_DIRECTORY)) {
    const std::string name = "tactile/fabric/" + fabric.name;
    printLine(name + "/smd", 1e6 * fabric.roughness, "um");
    printLine(name + "/a40", 1e6 * fabric.stroke.amplitudes[tactile::k40], "um");
    printLine(name + "/a320", 1e6 * fabric.stroke.amplitudes[tactile::k320], "um");
    printLine(name + "/ratio", fabric.stroke.ratio(), "1");
    printLine(name + "/intensity", 1e6 * fabric.stroke.intensity, "um");
  }
  for (const auto& weave : oracles::renderWeaves(HAPTEX_CONFIG_DIRECTORY)) {
    printLine("tactile/weave/" + weave.name + "/ratio", weave.stroke.ratio(), "1");
  }
  return 0;
}
