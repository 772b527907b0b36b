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

#include "haptex/studies/quality_choice.h"
#include "haptex/studies/trade_off_points.h"
#include "haptex/studies/trade_off_study.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr int kThreads = 2;
constexpr std::array kPresets = {"fast", "balanced", "accurate"};
constexpr double kMaxCost = 3.0;  // computing time over simulated time, beyond which nobody goes

void printTable(const studies::TradeOffTable& table) {
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    const std::string of = std::string("trade_off/") + nameOf(table.cases[i].motion) + "/" +
                           table.cases[i].fabric.name + "/";
    tellErrors(of + "reference", table.references[i].own_error, bench::printLine);
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      const studies::TradeOffResult& result = table.results[k][i];
      if (!result.followed) continue;
      const std::string name = of + nameOf(table.points[k]);
      tellErrors(name, result.error, bench::printLine);
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
  for (const studies::TradeOffCaseName& name : studies::tradeOffCases(studies::tradeOffFabrics())) {
    table.cases.push_back(loadCase(name, HAPTEX_CONFIG_DIRECTORY));
  }
  table.points = studies::tradeOffPoints();
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
