// How long does it take from a pattern to a garment at rest on a body, and does it get there from
// any start? Prints for each shipped garment with edges of 20 mm, two on top of each other and
// a lined jacket with edges of 30 mm, the processor time from the panels to rest (inf: it did not
// come to rest), per simulated second too, and the pairs of triangles that intersect at rest. Then
// panels start somewhere else, turned about their middles: each up to 10 mm away in every direction
// and by up to 0.02 rad, or if they lie on carriers, 4 mm beside each other, 1.5 mm and 0.002 rad.
// Of so many starts (20, or the first argument; 0: none) of each garment, how many ended at rest
// without an intersection? Further arguments name the garments that are measured, and nothing else
// is then. What did not end so is told on the error output.
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "cushion.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/dressing/drape.h"
#include "haptex/dressing/lay_garment.h"
#include "haptex/material/fabric_file.h"
#include "soft_top.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Eigen::Vector3d;

constexpr int kStarts = 20;

struct Scene {
  const char* garment;
  const char* body;    // a file of config
  double shift;        // m, of disturbed starts
  double turn;         // rad
  double edge = 0.02;  // m
};
constexpr Scene kScenes[] = {{"shirt", "meshes/figure.obj", 0.01, 0.02},
                             {"fitted_shirt", "bodies/woman.yaml", 1.5e-3, 2e-3},
                             {"fitted_dress", "bodies/woman.yaml", 1.5e-3, 2e-3},
                             {"skirt", "bodies/figure.yaml", 1.5e-3, 2e-3},
                             {"trousers", "bodies/figure.yaml", 1.5e-3, 2e-3},
                             {"shirt_over_trousers", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03},
                             {"shirt_in_trousers", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03},
                             {"jacket", "bodies/figure.yaml", 1.5e-3, 2e-3, 0.03}};

std::vector<material::Fabric> fabricsOf(const garment::GarmentMesh& garment) {
  std::vector<material::Fabric> fabrics;
  for (const std::string& name : garment.fabrics) {
    fabrics.push_back(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml"));
  }
  return fabrics;
}

/// Moves the panels of a garment that is not sewn yet.
void disturb(mesh::ClothMesh& mesh, const Scene& scene, unsigned seed) {
  base::RepeatableRandom random(seed);
  const auto draw = [&](double most) {
    return Vector3d(random.uniform(-most, most), random.uniform(-most, most),
                    random.uniform(-most, most));
  };
  for (int p = 0; p < mesh.panelCount(); ++p) {
    std::set<int> particles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.panelOf(t) == p)
        particles.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    }
    Vector3d middle = Vector3d::Zero();
    for (const int i : particles) {
      middle += mesh.initial_positions[i] / static_cast<double>(particles.size());
    }
    const Vector3d shift = draw(scene.shift), turn = draw(scene.turn);
    const Eigen::AngleAxisd rotation(turn.norm(), turn.normalized());
    for (const int i : particles) {
      Vector3d& place = mesh.initial_positions[i];
      place = middle + shift + rotation * (place - middle);
    }
  }
}

/// Tells `start` and what is wrong on the error output if it does not.
bool endsAtRest(const dressing::LaidGarment& laid, const std::vector<material::Fabric>& fabrics,
                const dressing::DrapeSettings& settings, const std::string& start) {
  try {
    const dressing::DrapeOutcome outcome =
        dressing::drape(laid.garment, fabrics, laid.body, settings);
    if (outcome.isSound()) return true;
    std::fprintf(stderr, "%s: %s, %d states intersect, at the end %d pairs\n", start.c_str(),
                 outcome.at_rest ? "at rest" : "not at rest", outcome.intersecting_states,
                 static_cast<int>(outcome.with_itself + outcome.with_body));
  } catch (const std::exception& refusal) {
    std::fprintf(stderr, "%s: %s\n", start.c_str(), refusal.what());
  }
  return false;
}

void measure(const Scene& scene, int starts) {
  const dressing::CoarseStart coarse = dressing::coarseStart(scene.edge);
  dressing::DrapeSettings settings;
  settings.halvings = coarse.halvings;
  const std::string config = HAPTEX_CONFIG_DIRECTORY "/";
  const dressing::LaidGarment laid = dressing::layGarment(
      config + "garments/" + scene.garment + ".yaml", config + scene.body, coarse.edge_length);
  const std::vector<material::Fabric> fabrics = fabricsOf(laid.garment);
  const dressing::DrapeOutcome outcome =
      dressing::drape(laid.garment, fabrics, laid.body, settings);
  const std::string name = std::string("garment/") + scene.garment + "/";
  bench::printLine(name + "s_per_s",
                   outcome.computing_seconds / (outcome.closing_time + outcome.settling_time),
                   "s/s");
  constexpr double kNever = std::numeric_limits<double>::infinity();
  bench::printLine(name + "to_rest", outcome.at_rest ? outcome.computing_seconds : kNever, "s");
  bench::printLine(name + "intersections",
                   static_cast<double>(outcome.with_itself + outcome.with_body), "1");
  int at_rest = 0;
  for (int seed = 1; seed <= starts; ++seed) {
    dressing::LaidGarment disturbed = laid;
    disturb(disturbed.garment.mesh, scene, static_cast<unsigned>(seed));
    at_rest +=
        endsAtRest(disturbed, fabrics, settings, name + "start " + std::to_string(seed)) ? 1 : 0;
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
    const auto named = [&](const Scene& scene) { return scene.garment == name; };
    if (std::any_of(std::begin(kScenes), std::end(kScenes), named)) continue;
    std::fprintf(stderr, "bench_garment: no garment '%s'; there are:", name.c_str());
    for (const Scene& scene : kScenes) std::fprintf(stderr, " %s", scene.garment);
    std::fprintf(stderr, "\n");
    return 2;
  }
  if (only.empty()) {
    bench::measureSoftTop();
    bench::measureCushion();
  }
  for (const Scene& scene : kScenes) {
    if (only.empty() || only.count(scene.garment) > 0) measure(scene, starts);
  }
}
