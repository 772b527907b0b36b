// What does it cost to find out where a cloth is near itself? A flat hanging sheet has to pay for
// no more than for knowing that it is flat, as a share of its step; a crumpled one for all pairs.
// And what does cloth cost that touches itself: computing time per triangle and simulated second,
// and how many triangles intersect in the worst of its states.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/mesh.h"
#include "haptex/oracles/exact/moving_elements.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "haptex/oracles/scenes/self_collision_scenes.h"
#include "haptex/oracles/scenes/tangled_starts.h"
#include "haptex/proximity/continuous.h"
#include "haptex/proximity/intersections.h"
#include "haptex/proximity/self_proximity.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using namespace haptex::proximity;
using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

constexpr double kSide = 0.2;           // m
constexpr double kStep = 0.0125;        // s
constexpr double kDistanceShare = 0.2;  // of a cell's width, up to which pairs are near
constexpr double kMinTime = 0.1;        // s per repetition

struct Sheet {
  explicit Sheet(int cells_of_a_side)
      : cells(cells_of_a_side),
        mesh(mesh::makeRectangle(kSide, kSide, cells, cells, mesh::Triangulation::kAlternating)),
        rest(oracles::deformedSheet(mesh, "flat")) {}
  double distance() const { return kDistanceShare * kSide / cells; }
  std::string name() const { return std::to_string(mesh.triangles.size()); }

  int cells;
  mesh::ClothMesh mesh;
  Positions rest;
};

/// A sheet of a linear fabric that hangs by its top edge and has come to rest.
struct HangingSheet {
  explicit HangingSheet(const Sheet& sheet)
      : cloth(sheet.mesh, material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml"), {}),
        integrator(cloth, settings()),
        state(cloth.initialState()) {
    for (const int particle : mesh::sideParticles(sheet.mesh, mesh::Side::kTop)) {
      cloth::AttachmentPath path;
      path.start = sheet.mesh.initial_positions[static_cast<std::size_t>(particle)];
      cloth.attach(particle, path);
    }
    for (int i = 0; i < 80; ++i) step();
  }
  /// The shortest step that is worth its name: the share of the test is the largest.
  static cloth::StepSettings settings() {
    cloth::StepSettings settings;
    settings.tolerance = 1e-4;
    settings.newton_iterations = 1;
    return settings;
  }
  void step() { integrator.step(cloth, state, kStep); }

  cloth::Cloth cloth;
  cloth::Integrator integrator;
  cloth::ClothState state;
};

void addFind(const std::string& name, const Sheet& sheet, const Positions& positions) {
  bench::add(name, kMinTime, [&sheet, positions](benchmark::State& run) {
    KdopHierarchy hierarchy(sheet.mesh.triangles, sheet.rest);
    SelfProximity self(hierarchy, sheet.rest, sheet.distance());
    hierarchy.refit(positions);
    std::vector<NearPair> found;
    for (auto _ : run) self.find(found);
  });
  bench::add(name + "_bounds", kMinTime, [&sheet, positions](benchmark::State& run) {
    KdopHierarchy hierarchy(sheet.mesh.triangles, sheet.rest);
    SelfProximity self(hierarchy, sheet.rest, sheet.distance());
    hierarchy.refit(positions);
    std::vector<NearPair> found;
    std::vector<double> bounds;
    for (auto _ : run) self.find(found, &bounds);
  });
}

void printCost(const std::string& name, const Sheet& sheet, const Positions& positions) {
  KdopHierarchy hierarchy(sheet.mesh.triangles, sheet.rest);
  SelfProximity self(hierarchy, sheet.rest, sheet.distance());
  hierarchy.refit(positions);
  std::vector<NearPair> found;
  SelfProximityCost cost;
  self.find(found);
  self.find(found, nullptr, &cost);
  const auto print = [&](const char* what, double value, const char* unit) {
    bench::printLine("self_collision/" + name + "/" + what, value, unit);
  };
  print("pairs", static_cast<double>(found.size()), "pairs");
  print("volume_pairs", static_cast<double>(cost.volume_pairs), "pairs");
  print("flat_tests", static_cast<double>(cost.flat_tests), "volumes");
  print("leaf_pairs", static_cast<double>(cost.leaf_pairs), "pairs");
  print("distances", static_cast<double>(cost.distances), "pairs");
}

/// Of a million cases how many contacts were missed, what a test takes, and where it has to end its
/// search undecided although no contact is known.
void printContinuous() {
  constexpr int kCases = 1000000;
  oracles::MovingElementCases cases;
  int contacts = 0, missed = 0, others = 0;
  double seconds = 0.0;
  std::vector<oracles::MovingElements> batch(1000);
  for (int i = 0; i < kCases / 1000; ++i) {
    for (auto& elements : batch) elements = cases.next();
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& elements : batch) {
      const auto found = earliestContact(elements.kind, elements.begin, elements.end);
      contacts += elements.contact.has_value();
      missed += elements.contact && !(found && *found <= *elements.contact);
      others += !elements.contact && found;
    }
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  bench::printLine("self_collision/continuous/contacts", contacts, "pairs");
  bench::printLine("self_collision/continuous/missed", missed, "pairs");
  bench::printLine("self_collision/continuous/reported_beside_these", others, "pairs");
  bench::printLine("self_collision/continuous/time", 1e6 * seconds / kCases, "us");
}

/// Of wool, in steps of 12.5 ms.
void printScene(const oracles::SelfCollidingCloth::Set& set, const std::string& name,
                int newton_iterations) {
  cloth::StepSettings settings;
  settings.newton_iterations = newton_iterations;
  oracles::SelfCollidingCloth scene(
      set, {material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml")}, settings);
  const auto& triangles = scene.cloth.mesh().triangles;
  const int steps = static_cast<int>(std::lround(set.duration / kStep));
  double seconds = 0.0;
  int cut = 0;
  std::size_t intersections = 0;
  for (int i = 0; i < steps; ++i) {
    const cloth::StepReport report = scene.step(kStep);
    seconds += report.total_seconds;
    cut += report.self_cut.particles > 0;
    intersections = std::max(intersections, scene.intersections());
  }
  const auto print = [&](const char* what, double value, const char* unit) {
    bench::printLine("self_collision/" + name + "/" + what, value, unit);
  };
  const double per_second = seconds / (steps * kStep);
  print("ms_per_triangle_second", 1e3 * per_second / static_cast<double>(triangles.size()), "ms/s");
  print("seconds_per_second", per_second, "s/s");
  print("intersections", static_cast<double>(intersections), "pairs");
  print("steps_cut", static_cast<double>(cut) / steps, "ratio");
}

void printScenes() {
  for (const oracles::SelfCollidingCloth::Set& set : oracles::selfCollisionScenes(8)) {
    printScene(set, set.name, 5);
  }
  for (const oracles::SelfCollidingCloth::Set& set : oracles::selfCollisionScenes(35)) {
    if (set.name == "gathered") printScene(set, "gathered_9800", 3);
  }
}

/// Of 100 random tangled starts, after a second.
void printTangled() {
  const oracles::UntangledStarts ends = oracles::untangleStarts(100, 80, HAPTEX_CONFIG_DIRECTORY);
  bench::printLine("self_collision/tangled/free", ends.free_share, "ratio");
  bench::printLine("self_collision/tangled/left", static_cast<double>(ends.left), "pairs");
  bench::printLine("self_collision/tangled/misreported", ends.misreported, "steps");
}

}  // namespace

int main(int argc, char** argv) {
  const Sheet small(32), large(215);
  HangingSheet hanging(small);
  const Positions at_rest = hanging.state.positions;
  addFind("self_collision/flat", small, at_rest);
  bench::add("self_collision/refit", kMinTime, [&](benchmark::State& run) {
    KdopHierarchy hierarchy(small.mesh.triangles, small.rest);
    for (auto _ : run) hierarchy.refit(at_rest);
  });
  bench::add("self_collision/step", kMinTime, [&](benchmark::State& run) {
    for (auto _ : run) hanging.step();
  });
  const char* const crumpled[] = {"crumpled_1", "crumpled_to_a_ball", "folded_twice"};
  for (const char* state : crumpled) {
    addFind(std::string("self_collision/") + state, large,
            oracles::deformedSheet(large.mesh, state));
  }
  bench::add("self_collision/refit_large", kMinTime, [&](benchmark::State& run) {
    const Positions positions = oracles::deformedSheet(large.mesh, "crumpled_1");
    KdopHierarchy hierarchy(large.mesh.triangles, large.rest);
    for (auto _ : run) hierarchy.refit(positions);
  });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  bench::TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (reporter.failed()) return 1;
  if (reporter.has("self_collision/flat") && reporter.has("self_collision/step")) {
    bench::printLine("self_collision/flat_share",
                     reporter.time("self_collision/flat") / reporter.time("self_collision/step"),
                     "ratio");
  }
  printScenes();
  printTangled();
  printContinuous();
  printCost("flat", small, at_rest);
  for (const char* state : crumpled) {
    printCost(state, large, oracles::deformedSheet(large.mesh, state));
  }
  return 0;
}
