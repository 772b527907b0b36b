// What does it cost to follow a moving sheet with volumes and to ask which elements are near a
// fingertip, beside FCL in the same run? What do more planes, larger leaves and wider registers
// buy, and would it pay to refit only what has moved? The sheet is 0.2 m wide and crumpled; the
// fingertip is a sphere of 12 mm at 500 places near it, the same for all.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/mesh.h"
#include "haptex/oracles/experiments/fcl_sheet.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "haptex/proximity/kdop_hierarchy.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using namespace haptex::proximity;
using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

constexpr double kSide = 0.2;               // m
constexpr double kFingertipRadius = 0.012;  // m
constexpr int kPlaces = 500;
constexpr double kRefitMargin = 1e-3;  // m, by which leaves might lag behind
constexpr double kMinTime = 0.04;      // s per repetition

/// A sheet, where it is, and where it is asked about.
struct Case {
  explicit Case(int cells)
      : mesh(mesh::makeRectangle(kSide, kSide, cells, cells, mesh::Triangulation::kAlternating)),
        name(std::to_string(mesh.triangles.size())),
        rest(oracles::deformedSheet(mesh, "flat")),
        positions(oracles::deformedSheet(mesh, "crumpled_1")) {
    // As many elements in reach as of the smallest sheet.
    const double scale = 32.0 / cells;
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> offset(-kFingertipRadius, kFingertipRadius);
    std::uniform_real_distribution<double> along(0.0, 1.0);
    for (int i = 0; i < kPlaces; ++i) {
      const int column = static_cast<int>(along(generator) * cells);
      const int row = static_cast<int>(along(generator) * cells);
      const Vector3d& near = positions[row * (cells + 1) + column];
      const double x = offset(generator), y = offset(generator), z = offset(generator);
      places.push_back(near + Vector3d(x, y, z));
      nearer_places.push_back(near + scale * Vector3d(x, y, z));
    }
    smaller_radius = scale * kFingertipRadius;
  }

  mesh::ClothMesh mesh;
  std::string name;
  Positions rest, positions;
  Positions places;
  Positions nearer_places;  // for the smaller fingertip
  double smaller_radius;    // m
};

HierarchySettings settingsOf(KdopKind kind, int triangles_per_leaf) {
  return {kind, triangles_per_leaf, bestInstructionSet()};
}

void addRefit(const std::string& name, const Case& c, const HierarchySettings& settings) {
  bench::add(name, kMinTime, [&c, settings](benchmark::State& run) {
    KdopHierarchy hierarchy(c.mesh.triangles, c.rest, settings);
    for (auto _ : run) hierarchy.refit(c.positions);
  });
}

/// One iteration is one query, at the next place.
void addQuery(const std::string& name, const Case& c, const HierarchySettings& settings,
              const std::vector<Cursor>& cursors, const Range& range) {
  bench::add(name, kMinTime, [&c, settings, cursors, range](benchmark::State& run) {
    KdopHierarchy hierarchy(c.mesh.triangles, c.rest, settings);
    hierarchy.refit(c.positions);
    std::vector<NearElement> found;
    found.reserve(c.mesh.triangles.size());
    std::size_t next = 0;
    for (auto _ : run) {
      hierarchy.query(cursors[next], range, found);
      next = (next + 1) % cursors.size();
    }
  });
}

std::vector<Cursor> cursorsAt(const Positions& places,
                              const std::function<Cursor(const Vector3d&)>& cursor_at) {
  std::vector<Cursor> cursors;
  for (const Vector3d& place : places) cursors.push_back(cursor_at(place));
  return cursors;
}

std::vector<Cursor> fingertips(const Positions& places, double radius) {
  return cursorsAt(places, [radius](const Vector3d& place) {
    return Cursor::spheres({{place, radius}});
  });
}

std::vector<Cursor> capsules(const Positions& places) {
  return cursorsAt(places, [](const Vector3d& place) {
    return Cursor::capsule(place, place + Vector3d(0.0, 0.0, kFingertipRadius), kFingertipRadius);
  });
}

template <typename Volume>
void addFcl(const std::string& suffix, const Case& c) {
  bench::add("proximity/build" + suffix + "/" + c.name, kMinTime, [&c](benchmark::State& run) {
    for (auto _ : run) oracles::FclSheet<Volume> sheet(c.mesh.triangles, c.positions);
  });
  bench::add("proximity/refit" + suffix + "/" + c.name, kMinTime, [&c](benchmark::State& run) {
    oracles::FclSheet<Volume> sheet(c.mesh.triangles, c.positions);
    for (auto _ : run) sheet.refit(c.positions);
  });
  bench::add("proximity/query" + suffix + "/" + c.name, kMinTime, [&c](benchmark::State& run) {
    const oracles::FclSheet<Volume> sheet(c.mesh.triangles, c.positions);
    std::size_t next = 0;
    for (auto _ : run) {
      benchmark::DoNotOptimize(sheet.touched({c.places[next], kFingertipRadius}));
      next = (next + 1) % c.places.size();
    }
  });
}

/// Which leaves moved by more than a margin since the last refit: the least that refitting only
/// those would have to find out first, each time the positions change.
void addMotionCheck(const Case& c) {
  bench::add("proximity/motion_check/" + c.name, kMinTime, [&c](benchmark::State& run) {
    Positions fitted = c.positions;
    std::vector<char> moved(fitted.size());
    for (auto _ : run) {
      for (std::size_t i = 0; i < fitted.size(); ++i) {
        moved[i] = (c.positions[i] - fitted[i]).squaredNorm() > kRefitMargin * kRefitMargin;
      }
      benchmark::DoNotOptimize(moved.data());
      benchmark::ClobberMemory();
    }
  });
}

void addCase(const Case& c) {
  const HierarchySettings standard;
  bench::add("proximity/build/" + c.name, kMinTime, [&c](benchmark::State& run) {
    for (auto _ : run) KdopHierarchy hierarchy(c.mesh.triangles, c.rest);
  });
  addRefit("proximity/refit/" + c.name, c, standard);
  addQuery("proximity/query/" + c.name, c, standard, fingertips(c.places, kFingertipRadius), {0.0});
  addQuery("proximity/query_constant_hits/" + c.name, c, standard,
           fingertips(c.nearer_places, c.smaller_radius), {0.0});
  addQuery("proximity/query_nearest/" + c.name, c, standard, cursorsAt(c.places, Cursor::point),
           {std::numeric_limits<double>::infinity(), 1});
  addFcl<fcl::AABBd>("_fcl_aabb", c);
  addFcl<fcl::KDOP<double, 24>>("_fcl_kdop24", c);
  addMotionCheck(c);
}

constexpr std::pair<KdopKind, int> kKinds[] = {
    {KdopKind::k6, 6}, {KdopKind::k14, 14}, {KdopKind::k18, 18}, {KdopKind::k26, 26}};

std::string kindName(int planes) { return "_k" + std::to_string(planes) + "/"; }

void addVariants(const Case& c) {
  const HierarchySettings standard;
  const std::vector<Cursor> spheres = fingertips(c.places, kFingertipRadius);
  for (const auto& [kind, planes] : kKinds) {
    const HierarchySettings settings = settingsOf(kind, standard.triangles_per_leaf);
    addRefit("proximity/refit" + kindName(planes) + c.name, c, settings);
    addQuery("proximity/query" + kindName(planes) + c.name, c, settings, spheres, {0.0});
    addQuery("proximity/query_capsule" + kindName(planes) + c.name, c, settings, capsules(c.places),
             {0.0});
  }
  for (const int leaf : {1, 4, 8, 16, 32}) {
    const HierarchySettings settings = settingsOf(standard.kind, leaf);
    const std::string suffix = "_leaf" + std::to_string(leaf) + "/" + c.name;
    addRefit("proximity/refit" + suffix, c, settings);
    addQuery("proximity/query" + suffix, c, settings, spheres, {0.0});
  }
  HierarchySettings plain;
  plain.instruction_set = InstructionSet::kBaseline;
  addRefit("proximity/refit_baseline/" + c.name, c, plain);
  addQuery("proximity/query_baseline/" + c.name, c, plain, spheres, {0.0});
  addQuery("proximity/query_point/" + c.name, c, standard, cursorsAt(c.places, Cursor::point),
           {kFingertipRadius});
  addQuery("proximity/query_three_spheres/" + c.name, c, standard,
           cursorsAt(c.places,
                     [](const Vector3d& p) {
                       const Vector3d beside(0.0, 0.0, 0.01);
                       return Cursor::spheres({{p, 0.012}, {p + beside, 0.01}, {p - beside, 0.01}});
                     }),
           {0.0});
  addQuery("proximity/query_capsule/" + c.name, c, standard, capsules(c.places), {0.0});
  addQuery(
      "proximity/query_tapered_capsule/" + c.name, c, standard,
      cursorsAt(c.places,
                [](const Vector3d& p) {
                  return Cursor::taperedCapsule({p, 0.012}, {p + Vector3d(0, 0, 0.012), 0.008});
                }),
      {0.0});
  addQuery("proximity/query_with_margin/" + c.name, c, standard, spheres, {kRefitMargin});
}

/// Prints what a query tests, mean over the cursors.
void printVisits(const std::string& suffix, const Case& c, const HierarchySettings& settings,
                 const std::vector<Cursor>& cursors) {
  KdopHierarchy hierarchy(c.mesh.triangles, c.rest, settings);
  hierarchy.refit(c.positions);
  QueryCost cost;
  std::vector<NearElement> found;
  for (const Cursor& cursor : cursors) hierarchy.query(cursor, {0.0}, found, &cost);
  const double queries = static_cast<double>(cursors.size());
  bench::printLine("proximity/volumes" + suffix + c.name,
                   static_cast<double>(cost.volumes) / queries, "volumes");
  bench::printLine("proximity/triangles" + suffix + c.name,
                   static_cast<double>(cost.triangles) / queries, "triangles");
}

/// Mean number of hits, and in how many queries FCL finds other elements. Elements that are within
/// 1e-9 m of touching may differ.
void printEquality(const Case& c) {
  KdopHierarchy hierarchy(c.mesh.triangles, c.rest);
  hierarchy.refit(c.positions);
  const oracles::FclSheet<fcl::KDOP<double, 24>> sheet(c.mesh.triangles, c.positions);
  std::vector<NearElement> found;
  std::size_t hits = 0;
  int different = 0;
  for (const Vector3d& place : c.places) {
    const Sphere fingertip{place, kFingertipRadius};
    hierarchy.query(Cursor::spheres({fingertip}), {0.0}, found);
    hits += found.size();
    different += !oracles::agree(hierarchy, sheet, fingertip, 1e-9);
  }
  bench::printLine("proximity/hits/" + c.name, static_cast<double>(hits) / kPlaces, "elements");
  bench::printLine("proximity/different_from_fcl_kdop24/" + c.name, different, "queries");
}

/// Mean share of the particles that move by more than the margin from one state to the next, while
/// the sheet swings from one edge for two seconds at 80 states per second.
double movedInSwing(const Case& c) {
  cloth::ModelledEffects effects;
  effects.gravity = {base::kStandardGravity, 0.0, 0.0};  // across the hanging sheet
  cloth::Cloth cloth(c.mesh, material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml"),
                     effects);
  for (const int particle : mesh::sideParticles(c.mesh, mesh::Side::kTop)) {
    cloth::AttachmentPath path;
    path.start = c.mesh.initial_positions[static_cast<std::size_t>(particle)];
    cloth.attach(particle, path);
  }
  cloth::Integrator integrator(cloth, {});
  cloth::ClothState state = cloth.initialState();
  constexpr int kSteps = 160;
  std::size_t moved = 0;
  for (int step = 0; step < kSteps; ++step) {
    const Positions before = state.positions;
    integrator.step(cloth, state, 0.0125);
    for (std::size_t i = 0; i < before.size(); ++i) {
      moved += (state.positions[i] - before[i]).norm() > kRefitMargin;
    }
  }
  return static_cast<double>(moved) / static_cast<double>(kSteps * state.positions.size());
}

}  // namespace

int main(int argc, char** argv) {
  const Case cases[] = {Case(32), Case(71), Case(158)};
  const Case& middle = cases[1];
  for (const Case& c : cases) addCase(c);
  addVariants(middle);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  bench::TabReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (reporter.failed()) return 1;
  for (const Case& c : cases) printEquality(c);
  for (const auto& [kind, planes] : kKinds) {
    printVisits(kindName(planes), middle, settingsOf(kind, HierarchySettings().triangles_per_leaf),
                fingertips(middle.places, kFingertipRadius));
  }
  for (const Case& c : cases) {  // the growth without the caches
    printVisits("_constant_hits/", c, {}, fingertips(c.nearer_places, c.smaller_radius));
  }

  const auto ratio = [&](const std::string& name, const std::string& a, const std::string& b) {
    bench::printLine("proximity/" + name,
                     reporter.time("proximity/" + a) / reporter.time("proximity/" + b), "ratio");
  };
  for (const Case& c : cases) {
    ratio("refit_ratio/" + c.name, "refit_fcl_kdop24/" + c.name, "refit/" + c.name);
    ratio("query_ratio/" + c.name, "query_fcl_kdop24/" + c.name, "query/" + c.name);
    ratio("refit_ratio_aabb/" + c.name, "refit_fcl_aabb/" + c.name, "refit/" + c.name);
    ratio("query_ratio_aabb/" + c.name, "query_fcl_aabb/" + c.name, "query/" + c.name);
    ratio("motion_check_ratio/" + c.name, "motion_check/" + c.name, "refit/" + c.name);
  }
  ratio("query_with_margin_ratio/" + middle.name, "query_with_margin/" + middle.name,
        "query/" + middle.name);
  bench::printLine("proximity/moved_in_swing/" + cases[0].name, movedInSwing(cases[0]), "fraction");
  const std::string small = cases[0].name, large = cases[2].name;
  const double triangles = std::log(static_cast<double>(cases[2].mesh.triangles.size()) /
                                    static_cast<double>(cases[0].mesh.triangles.size()));
  const auto growth = [&](const std::string& name) {
    return reporter.time("proximity/" + name + "/" + large) /
           reporter.time("proximity/" + name + "/" + small);
  };
  const std::string from_to = "/" + small + "_" + large;
  bench::printLine("proximity/refit_exponent" + from_to, std::log(growth("refit")) / triangles,
                   "exponent");
  bench::printLine("proximity/query_constant_hits_growth" + from_to, growth("query_constant_hits"),
                   "ratio");
  bench::printLine("proximity/logarithm_growth" + from_to,
                   std::log2(static_cast<double>(cases[2].mesh.triangles.size())) /
                       std::log2(static_cast<double>(cases[0].mesh.triangles.size())),
                   "ratio");
  return 0;
}
