// Proximity queries on sheets that are crumpled at random, against brute force.
#include <algorithm>

#include "haptex/base/workload.h"
#include "haptex/mesh/mesh.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;
using proximity::Cursor;
using proximity::NearElement;

}  // namespace

void randomQueries(const std::string&, Random& random, const Sink& sink) {
  constexpr int kStates = base::unlessSanitized(5, 1), kQueries = 50;
  int wrong = 0;
  for (int i = 0; i < kStates; ++i) {
    const int cells = 4 + random.below(25);
    const double cell = random.logarithmic(1e-3, 0.1), crumpled = random.logarithmic(1e-3, 10.0);
    const mesh::ClothMesh mesh = mesh::makeRectangle(cells * cell, cells * cell, cells, cells,
                                                     mesh::Triangulation::kAlternating);
    std::vector<Vector3d> positions = mesh.initial_positions;
    const Vector3d away = random.logarithmic(0.01, 100.0) * random.direction();
    for (Vector3d& place : positions) {
      place += away + crumpled * cell * random.uniform(0.0, 1.0) * random.direction();
    }
    proximity::KdopHierarchy hierarchy(mesh.triangles, positions);
    std::vector<NearElement> found;
    for (int k = 0; k < kQueries; ++k) {
      const auto place = [&] {
        const auto particle = static_cast<std::size_t>(random.below(positions.size()));
        return Vector3d(positions[particle] +
                        3.0 * cell * random.uniform(0.0, 1.0) * random.direction());
      };
      const Vector3d first = place(), second = place();
      const double radius = 2.0 * cell * random.uniform(0.0, 1.0);
      const Cursor cursor = random.chance(0.5) ? Cursor::spheres({{first, radius}})
                                               : Cursor::capsule(first, second, radius);
      proximity::Range range{2.0 * cell * random.uniform(0.0, 1.0)};
      if (random.chance(0.3)) range.count = 1 + random.below(20);
      hierarchy.query(cursor, range, found);
      const std::vector<NearElement> exact = proximity::nearElementsByBruteForce(
          hierarchy.triangles(), hierarchy.positions(), cursor, range);
      wrong += !std::equal(found.begin(), found.end(), exact.begin(), exact.end(),
                           [](const NearElement& a, const NearElement& b) {
                             return a.triangle == b.triangle && a.distance == b.distance;
                           });
    }
  }
  CaseName text("proximity", "queries");
  text.with("wrong_of", kStates * kQueries);
  sink({text.text(), 0.0, static_cast<double>(wrong), static_cast<double>(wrong), 0.0});
}

}  // namespace haptex::oracles
