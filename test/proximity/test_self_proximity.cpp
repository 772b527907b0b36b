#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "fixtures.h"
#include "haptex/base/workload.h"
#include "haptex/proximity/self_proximity.h"

namespace haptex::proximity::test_self_proximity {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;
using Triangles = std::vector<std::array<int, 3>>;

constexpr double kSide = 0.2;  // m, of the sheets

/// What SelfProximity has to find, and the bounds of the particles, by asking all pairs.
struct Expected {
  Expected(const MeshElements& elements, const Positions& reference, const Positions& positions,
           double distance)
      : bounds(positions.size(), 0.5 * distance) {
    const auto excluded = nearPairsByBruteForce(elements, reference, distance);
    for (const ElementPair& pair : nearPairsByBruteForce(elements, positions, distance)) {
      const auto vertices = verticesOf(pair, elements);
      const double apart = distanceOf(pair.kind, {positions[vertices[0]], positions[vertices[1]],
                                                  positions[vertices[2]], positions[vertices[3]]})
                               .distance;
      for (int vertex : vertices) bounds[vertex] = std::min(bounds[vertex], 0.5 * apart);
      if (!std::binary_search(excluded.begin(), excluded.end(), pair)) pairs.push_back(pair);
    }
  }
  std::vector<ElementPair> pairs;
  std::vector<double> bounds;
};

std::vector<ElementPair> pairsOf(const std::vector<NearPair>& found) {
  std::vector<ElementPair> pairs;
  for (const NearPair& pair : found) pairs.push_back(pair.elements);
  return pairs;
}

/// Compares with all pairs, and says how many there are and whether anything was left out.
struct Outcome {
  std::size_t pairs;
  SelfProximityCost cost;
};
Outcome expectAll(const Triangles& triangles, const Positions& reference,
                  const Positions& positions, double distance) {
  KdopHierarchy hierarchy(triangles, reference);
  SelfProximity self(hierarchy, reference, distance);
  hierarchy.refit(positions);
  std::vector<NearPair> found;
  std::vector<double> bounds;
  SelfProximityCost cost;
  self.find(found, &bounds, &cost);
  const Expected expected(self.elements(), reference, positions, distance);
  std::vector<ElementPair> pairs = pairsOf(found);
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end()) << "a pair came twice";
  std::vector<ElementPair> missing, extra;
  std::set_difference(expected.pairs.begin(), expected.pairs.end(), pairs.begin(), pairs.end(),
                      std::back_inserter(missing));
  std::set_difference(pairs.begin(), pairs.end(), expected.pairs.begin(), expected.pairs.end(),
                      std::back_inserter(extra));
  EXPECT_EQ(missing.size(), 0u) << "of " << expected.pairs.size();
  EXPECT_EQ(extra.size(), 0u);
  EXPECT_EQ(bounds, expected.bounds);
  return {pairs.size(), cost};
}

TEST(SelfProximity, FindsWhatAllPairsHaveOnDeformedSheets) {
  constexpr int kCells = base::unlessSanitized(14, 7);
  const mesh::ClothMesh mesh = sheet(kCells);
  const Positions reference = restPositions(mesh);
  const double cell = kSide / kCells;
  std::size_t pairs = 0;
  for (const auto& state : oracles::deformedSheets(mesh)) {
    // From a thin fabric to one that is thicker than its elements are wide.
    for (double distance : {0.0, 0.05 * cell, 0.3 * cell, 1.2 * cell}) {
      SCOPED_TRACE(state.name + " " + std::to_string(distance / cell));
      pairs += expectAll(mesh.triangles, reference, state.positions, distance).pairs;
    }
  }
  EXPECT_GT(pairs, base::unlessSanitized(100000u, 3000u));
}

TEST(SelfProximity, FindsWhatAllPairsHaveOnADisc) {
  const mesh::ClothMesh mesh = mesh::makeDisc(0.15, 10);
  for (double fold : {0.0, 0.5, 1.0, 2.0}) {
    Positions positions = mesh.initial_positions;
    for (Vector3d& x : positions) {
      // Wider and wider waves towards the rim, as of a drape.
      const double radius = x.norm(), angle = std::atan2(x.y(), x.x());
      x *= 1.0 / (1.0 + fold * radius / 0.15);
      x.z() = -0.8 * radius + 0.3 * fold * radius * std::sin(6.0 * angle);
    }
    expectAll(mesh.triangles, mesh.initial_positions, positions, 0.002);
  }
}

/// A sheet without the cells that a function tells, and mapped.
struct Cut {
  Cut(int cells_u, int cells_v, const std::function<bool(const Vector2d&)>& is_missing) {
    const mesh::ClothMesh whole = mesh::makeRectangle(kSide, kSide * cells_v / cells_u, cells_u,
                                                      cells_v, mesh::Triangulation::kAlternating);
    for (const Vector2d& rest : whole.rest_coordinates) {
      reference.push_back({rest.x(), rest.y(), 0.0});
    }
    for (const auto& t : whole.triangles) {
      const Vector3d middle = (reference[t[0]] + reference[t[1]] + reference[t[2]]) / 3.0;
      if (!is_missing(middle.head<2>() / kSide)) triangles.push_back(t);
    }
  }
  Positions mapped(const std::function<Vector3d(const Vector2d&)>& map) const {
    Positions positions;
    for (const Vector3d& x : reference) positions.push_back(map(x.head<2>()));
    return positions;
  }
  Triangles triangles;
  Positions reference;
};

// Cases in which all normals are the same, so that cones of normals miss what is near.

TEST(SelfProximity, SeesTheEndsOfAStripThatIsBentToARingInItsPlane) {
  const Cut strip(40, 4, [](const Vector2d&) { return false; });
  for (double turn : {5.5, 6.2, 6.6}) {
    for (double rise : {0.0, 0.0005}) {
      const auto positions = strip.mapped([&](const Vector2d& rest) {
        const double angle = turn * rest.x() / kSide, radius = kSide / turn - 0.3 * rest.y();
        return Vector3d(radius * std::cos(angle), radius * std::sin(angle), rise * angle);
      });
      const Outcome outcome = expectAll(strip.triangles, strip.reference, positions, 0.001);
      const std::size_t least = turn > 6.5 && rise == 0.0 ? 10 : 0;
      EXPECT_GE(outcome.pairs, least);
    }
  }
}

/// Both halves of a sheet turn towards each other in its plane, about a place on its middle line.
/// Beside the middle line above that place no element is deformed by much.
Vector3d closed(const Vector2d& rest, double side, double above, double turn) {
  const double share = above > 0.0 ? side : std::clamp((rest.x() / kSide - 0.5) / 0.2, -1.0, 1.0);
  return {rest.x() - turn * share * above, rest.y(), 0.0};
}

TEST(SelfProximity, SeesTheSidesOfASlotThatClosesInItsPlane) {
  constexpr int kCells = base::unlessSanitized(20, 16);
  const Cut slotted(kCells, kCells, [](const Vector2d& at) {
    return at.y() > 0.4 && std::abs(at.x() - 0.5) < 0.05;
  });
  std::size_t most = 0;
  for (double turn : {0.0, 0.05, 0.08, 0.1, 0.15}) {
    const auto positions = slotted.mapped([&](const Vector2d& rest) {
      const double side = rest.x() > 0.5 * kSide ? 1.0 : -1.0;
      return closed(rest, side, rest.y() - 0.4 * kSide, turn);
    });
    most = std::max(most, expectAll(slotted.triangles, slotted.reference, positions, 0.001).pairs);
  }
  EXPECT_GT(most, 50u);
}

TEST(SelfProximity, SeesTheSidesOfASlit) {
  // Two sheets side by side that are sewn together in the lower half only: the sides of the slit
  // have the same reference positions, and slide over each other.
  Cut whole(16, 16, [](const Vector2d&) { return false; });
  const int count = static_cast<int>(whole.reference.size());
  std::vector<int> twin(count, -1);
  for (int i = 0; i < count; ++i) {
    const Vector3d x = whole.reference[i];
    if (std::abs(x.x() - 0.5 * kSide) > 1e-9 || x.y() < 0.5 * kSide) continue;
    twin[i] = static_cast<int>(whole.reference.size());
    whole.reference.push_back(x);
  }
  for (auto& t : whole.triangles) {
    const double middle =
        (whole.reference[t[0]] + whole.reference[t[1]] + whole.reference[t[2]]).x() / 3.0;
    if (middle < 0.5 * kSide) continue;
    for (int& vertex : t) vertex = twin[vertex] >= 0 ? twin[vertex] : vertex;
  }
  std::vector<double> side(whole.reference.size(), 0.0);
  for (std::size_t i = 0; i < side.size(); ++i) {
    side[i] = whole.reference[i].x() > 0.5 * kSide || i >= twin.size() ? 1.0 : -1.0;
  }
  for (double turn : {0.0, 0.005, 0.1, 0.2}) {
    Positions positions = whole.reference;
    for (std::size_t i = 0; i < side.size(); ++i) {
      const Vector2d rest = whole.reference[i].head<2>();
      positions[i] = closed(rest, side[i], rest.y() - 0.45 * kSide, turn);
    }
    expectAll(whole.triangles, whole.reference, positions, 0.001);
  }
}

TEST(SelfProximity, SeesWhatWasTurnedOverInAFlatSheet) {
  // A vertex pushed through the opposite edge of its triangle, in the plane.
  const mesh::ClothMesh mesh = sheet(8);
  for (double push : {0.3, 0.9, 1.1, 2.2}) {
    Positions positions = restPositions(mesh);
    positions[4 * 9 + 4].x() += push * kSide / 8;
    expectAll(mesh.triangles, restPositions(mesh), positions, 0.001);
  }
}

TEST(SelfProximity, LooksAtNoElementOfAFlatSheet) {
  const mesh::ClothMesh mesh = sheet(32);
  const Positions reference = restPositions(mesh);
  KdopHierarchy hierarchy(mesh.triangles, reference);
  SelfProximity self(hierarchy, reference, 0.001);
  EXPECT_TRUE(self.neighbours().empty());
  Positions curved = reference;  // by up to 40 degrees
  for (Vector3d& x : curved) x.z() = 0.2 * kSide * std::sin(4.0 * x.x() / kSide);
  hierarchy.refit(curved);
  std::vector<NearPair> found;
  SelfProximityCost cost;
  self.find(found, nullptr, &cost);
  EXPECT_TRUE(found.empty());
  EXPECT_EQ(cost.flat_tests, 1);
  EXPECT_EQ(cost.volume_pairs, 0);
  EXPECT_EQ(cost.distances, 0);
}

TEST(SelfProximity, AnswersTheSameWhateverCameBefore) {
  const mesh::ClothMesh mesh = sheet(24);
  const Positions reference = restPositions(mesh);
  const double distance = 0.002;
  KdopHierarchy hierarchy(mesh.triangles, reference);
  SelfProximity kept(hierarchy, reference, distance);
  std::vector<NearPair> found, found_anew;
  std::size_t pairs = 0;
  SelfProximityCost cost, cost_anew;
  for (int step = 0; step < 80; ++step) {
    // Rolls up and unrolls slowly.
    const double curvature = 60.0 * std::sin(0.8 + 0.01 * step);
    Positions positions = reference;
    for (Vector3d& x : positions) {
      const double angle = curvature * x.x(), radius = 1.0 / curvature - 0.001 * angle;
      x = Vector3d(radius * std::sin(angle), x.y(), radius * (1.0 - std::cos(angle)));
    }
    hierarchy.refit(positions);
    kept.find(found, nullptr, &cost);
    SelfProximity anew(hierarchy, reference, distance);
    anew.find(found_anew, nullptr, &cost_anew);
    ASSERT_EQ(pairsOf(found), pairsOf(found_anew)) << step;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].nearest.distance, found_anew[i].nearest.distance);
      ASSERT_EQ(found[i].nearest.weights, found_anew[i].nearest.weights);
    }
    pairs += found.size();
  }
  EXPECT_GT(pairs, 1000u);
  EXPECT_LT(cost.volume_pairs, cost_anew.volume_pairs) << "the front was not kept";
}

TEST(SelfProximity, AnswersTheSameWithAnyNumberOfThreads) {
  const mesh::ClothMesh mesh = sheet(16);
  const Positions reference = restPositions(mesh);
  linear::ThreadPool pool(3);
  std::size_t pairs = 0;
  for (const auto& state : oracles::deformedSheets(mesh)) {
    KdopHierarchy hierarchy(mesh.triangles, reference);
    hierarchy.refit(state.positions);
    SelfProximity alone(hierarchy, reference, 0.002), shared = alone;
    std::vector<NearPair> found, found_shared;
    std::vector<double> bounds, bounds_shared;
    SelfProximityCost cost, cost_shared;
    alone.find(found, &bounds, &cost);
    shared.find(found_shared, &bounds_shared, &cost_shared, &pool);
    ASSERT_EQ(pairsOf(found), pairsOf(found_shared)) << state.name;
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(found[i].nearest.distance, found_shared[i].nearest.distance) << state.name;
    }
    EXPECT_EQ(bounds, bounds_shared);
    EXPECT_EQ(cost.distances, cost_shared.distances);
    pairs += found.size();
  }
  EXPECT_GT(pairs, 1000u);
}

TEST(SelfProximity, AnswersTheSameWithBaselineInstructions) {
  const mesh::ClothMesh mesh = sheet(20);
  const Positions reference = restPositions(mesh);
  const Positions positions = oracles::deformedSheet(mesh, "crumpled_to_a_ball");
  std::vector<std::vector<ElementPair>> answers;
  for (InstructionSet set : {InstructionSet::kBaseline, bestInstructionSet()}) {
    HierarchySettings settings;
    settings.instruction_set = set;
    KdopHierarchy hierarchy(mesh.triangles, reference, settings);
    SelfProximity self(hierarchy, reference, 0.002);
    hierarchy.refit(positions);
    std::vector<NearPair> found;
    self.find(found);
    answers.push_back(pairsOf(found));
  }
  EXPECT_GT(answers[0].size(), 100u);
  EXPECT_EQ(answers[0], answers[1]);
}

TEST(SelfProximity, RefusesDistancesThatAreNone) {
  const mesh::ClothMesh mesh = sheet(2);
  const KdopHierarchy hierarchy(mesh.triangles, restPositions(mesh));
  for (double bad : {-1e-3, std::nan(""), 2e9}) {
    EXPECT_THROW(SelfProximity(hierarchy, restPositions(mesh), bad), std::invalid_argument);
  }
  EXPECT_THROW(SelfProximity(hierarchy, {}, 1e-3), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::proximity::test_self_proximity
