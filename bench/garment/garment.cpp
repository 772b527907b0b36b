// How long does it take from a pattern to a garment at rest on a body, and does it get there from
// any start? Prints for each shipped garment with edges of 20 mm, two on top of each other and
// a lined jacket with edges of 30 mm, the time from the panels to rest on all processors (inf: it
// did not come to rest), per simulated second too, and the pairs of triangles that intersect at
// rest. Then panels start somewhere else, turned about their middles: each up to 10 mm away in
// every direction and by up to 0.02 rad, or if they lie on carriers, 4 mm beside each other, 1.5 mm
// and 0.002 rad. Of so many starts (20, or the first argument; 0: none) of each garment, how many
// ended at rest without an intersection? Further arguments name the garments that are measured, and
// nothing else is then. What did not end so is told on the error output.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <set>
#include <string>

#include "cushion.h"
#include "haptex/dressing/drape.h"
#include "haptex/studies/jobs/garment_starts.h"
#include "soft_top.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using studies::GarmentScene;
using studies::garmentScenes;
using studies::GarmentStart;

constexpr int kStarts = 20;

/// Tells `start` and what is wrong on the error output if it does not.
bool endsAtRest(const GarmentStart& garment, const std::string& start) {
  try {
    const dressing::DrapeOutcome outcome =
        dressing::drape(garment.laid.garment, garment.fabrics, garment.laid.body, garment.settings);
    if (outcome.isSound()) return true;
    std::fprintf(stderr, "%s: %s, %d states intersect, at the end %d pairs\n", start.c_str(),
                 outcome.at_rest ? "at rest" : "not at rest", outcome.intersecting_states,
                 static_cast<int>(outcome.with_itself + outcome.with_body));
  } catch (const std::exception& refusal) {
    std::fprintf(stderr, "%s: %s\n", start.c_str(), refusal.what());
  }
  return false;
}

void measure(const GarmentScene& scene, int starts) {
  GarmentStart start = studies::startOf(scene, HAPTEX_CONFIG_DIRECTORY);
  start.settings.threads = dressing::allThreads();
  const dressing::DrapeOutcome outcome =
      dressing::drape(start.laid.garment, start.fabrics, start.laid.body, start.settings);
  const std::string name = std::string("garment/") + scene.garment + "/";
  bench::printLine(name + "s_per_s",
                   outcome.wall_seconds / (outcome.closing_time + outcome.settling_time), "s/s");
  constexpr double kNever = std::numeric_limits<double>::infinity();
  bench::printLine(name + "to_rest", outcome.at_rest ? outcome.wall_seconds : kNever, "s");
  bench::printLine(name + "intersections",
                   static_cast<double>(outcome.with_itself + outcome.with_body), "1");
  int at_rest = 0;
  for (int seed = 1; seed <= starts; ++seed) {
    GarmentStart disturbed = start;
    studies::disturb(disturbed.laid.garment.mesh, disturbed.laid.body, scene,
                     static_cast<unsigned>(seed));
    at_rest += endsAtRest(disturbed, name + "start " + std::to_string(seed)) ? 1 : 0;
  }
  if (starts > 0) {
    bench::printLine(name + "at_rest", at_rest, ("of " + std::to_string(starts)).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int starts = argc > 1 ? std::atoi(argv[1]) : kStarts;
  const std::set<std::string> only(argv + std::min(argc, 2), argv + argc);
  for (const std::string& name : only) {
    const auto named = [&](const GarmentScene& scene) { return scene.garment == name; };
    if (std::any_of(garmentScenes().begin(), garmentScenes().end(), named)) continue;
    std::fprintf(stderr, "bench_garment: no garment '%s'; there are:", name.c_str());
    for (const GarmentScene& scene : garmentScenes()) std::fprintf(stderr, " %s", scene.garment);
    std::fprintf(stderr, "\n");
    return 2;
  }
  if (only.empty()) {
    bench::measureSoftTop();
    bench::measureCushion();
  }
  for (const GarmentScene& scene : garmentScenes()) {
    if (only.empty() || only.count(scene.garment) > 0) measure(scene, starts);
  }
}
