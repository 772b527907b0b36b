#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::proximity::test_kdop_hierarchy {
namespace {

using test::refusalOf;

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr KdopKind kKinds[] = {KdopKind::k6, KdopKind::k14, KdopKind::k18, KdopKind::k26};

std::vector<InstructionSet> instructionSets() {
  if (bestInstructionSet() == InstructionSet::kBaseline) return {InstructionSet::kBaseline};
  return {InstructionSet::kBaseline, bestInstructionSet()};
}

KdopHierarchy hierarchyOver(const mesh::ClothMesh& mesh, const HierarchySettings& settings = {}) {
  return KdopHierarchy(mesh.triangles, restPositions(mesh), settings);
}

/// Every number of both answers is the same, bit by bit.
void expectSame(const std::vector<NearElement>& found, const std::vector<NearElement>& exact,
                const std::string& what) {
  ASSERT_EQ(found.size(), exact.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].triangle, exact[i].triangle) << what;
    EXPECT_EQ(found[i].part, exact[i].part) << what;
    EXPECT_EQ(found[i].distance, exact[i].distance) << what;
    EXPECT_EQ(found[i].point, exact[i].point) << what;
    EXPECT_EQ(found[i].barycentric, exact[i].barycentric) << what;
    EXPECT_EQ(found[i].normal, exact[i].normal) << what;
  }
}

TEST(KdopHierarchy, AnswersAreThoseOfBruteForceInEveryState) {
  const mesh::ClothMesh mesh = sheet(14);
  for (const InstructionSet set : instructionSets()) {
    for (const KdopKind kind : kKinds) {
      HierarchySettings settings{kind, 1 + static_cast<int>(kind) * 3, set};
      KdopHierarchy hierarchy = hierarchyOver(mesh, settings);
      for (const auto& state : oracles::deformedSheets(mesh)) {
        hierarchy.refit(state.positions);
        const double size = (hierarchy.triangle(0)[0] - hierarchy.triangle(0)[1]).norm() + 1e-9;
        RandomCursors cursors(state.positions, 2.0 * size, 11);
        std::vector<NearElement> found;
        for (int i = 0; i < 15; ++i) {
          const Cursor cursor = cursors.next();
          Range range{2.0 * size * cursors.uniform()};
          if (i % 4 == 3) range.count = 1 + static_cast<std::size_t>(20 * cursors.uniform());
          if (i % 8 == 7) range.distance = kInfinity;
          hierarchy.query(cursor, range, found);
          expectSame(found,
                     nearElementsByBruteForce(mesh.triangles, state.positions, cursor, range),
                     state.name);
        }
      }
    }
  }
}

TEST(KdopHierarchy, VolumesHoldTheTrianglesOfTheirHalves) {
  const mesh::ClothMesh mesh = sheet(9);
  for (const KdopKind kind : kKinds) {
    KdopHierarchy hierarchy = hierarchyOver(mesh, {kind, 3, bestInstructionSet()});
    ASSERT_EQ(hierarchy.levels(), 7);  // 162 triangles, 64 leaves
    for (const auto& state : oracles::deformedSheets(mesh)) {
      hierarchy.refit(state.positions);
      double largest = 0.0;
      for (const Vector3d& p : state.positions) largest = std::max(largest, p.norm());
      for (const HalfSpace& side : hierarchy.volume(0, 0)) {
        double height = -kInfinity;
        for (const Vector3d& p : state.positions) height = std::max(height, side.normal.dot(p));
        EXPECT_NEAR(side.height, height, 1e-6 * largest) << state.name;
      }
      for (int level = 0; level + 1 < hierarchy.levels(); ++level) {
        for (int i = 0; i < 1 << level; ++i) {
          const Kdop whole = hierarchy.volume(level, i);
          const Kdop half = hierarchy.volume(level + 1, 2 * i);
          const Kdop other = hierarchy.volume(level + 1, 2 * i + 1);
          for (std::size_t k = 0; k < whole.size(); ++k) {
            EXPECT_EQ(whole[k].height, std::max(half[k].height, other[k].height));
          }
        }
      }
    }
  }
}

TEST(KdopHierarchy, EveryInstructionSetMakesTheSameVolumes) {
  const mesh::ClothMesh mesh = sheet(20);
  for (const KdopKind kind : kKinds) {
    KdopHierarchy plain = hierarchyOver(mesh, {kind, 8, InstructionSet::kBaseline});
    KdopHierarchy best = hierarchyOver(mesh, {kind, 8, bestInstructionSet()});
    for (const auto& state : oracles::deformedSheets(mesh)) {
      plain.refit(state.positions);
      best.refit(state.positions);
      for (int level = 0; level < plain.levels(); ++level) {
        for (int i = 0; i < 1 << level; ++i) {
          const Kdop a = plain.volume(level, i), b = best.volume(level, i);
          for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].height, b[k].height);
        }
      }
    }
  }
}

TEST(KdopHierarchy, EveryInstructionSetVisitsTheSameVolumesAndTheyAreTold) {
  const mesh::ClothMesh mesh = sheet(20);
  const auto state = oracles::deformedSheets(mesh)[12];
  for (const KdopKind kind : kKinds) {
    KdopHierarchy plain = hierarchyOver(mesh, {kind, 8, InstructionSet::kBaseline});
    KdopHierarchy best = hierarchyOver(mesh, {kind, 8, bestInstructionSet()});
    plain.refit(state.positions);
    best.refit(state.positions);
    RandomCursors cursors(state.positions, 0.02, 3);
    std::vector<NearElement> found;
    for (int i = 0; i < 100; ++i) {
      const Cursor cursor = cursors.next();
      for (const Range& range : {Range{0.01}, Range{kInfinity, 7}}) {
        QueryCost a, b;
        plain.query(cursor, range, found, &a);
        best.query(cursor, range, found, &b);
        EXPECT_EQ(a.volumes, b.volumes);
        EXPECT_EQ(a.triangles, b.triangles);
        const std::vector<VolumeIndex> tested = best.tested(cursor, range);
        EXPECT_EQ(static_cast<std::int64_t>(tested.size()), b.volumes);
        std::set<std::pair<int, int>> volumes;
        for (const VolumeIndex& volume : tested) {
          volumes.insert({volume.level, volume.index});
          if (volume.level > 0) {
            EXPECT_EQ(volumes.count({volume.level - 1, volume.index / 2}), 1u);
          }
        }
        EXPECT_EQ(volumes.size(), tested.size());
      }
    }
  }
}

TEST(KdopHierarchy, AQueryNearOnePlaceLeavesMostVolumesAlone) {
  const mesh::ClothMesh mesh = sheet(71);
  KdopHierarchy hierarchy = hierarchyOver(mesh);
  std::vector<NearElement> found;
  QueryCost cost;
  hierarchy.query(Cursor::spheres({{{0.1, 0.1, 0.0}, 0.006}}), {0.0}, found, &cost);
  EXPECT_GT(found.size(), 20u);
  EXPECT_LT(cost.volumes, 200);
  EXPECT_LT(cost.triangles, 150);
}

TEST(KdopHierarchy, ElementsAtExactlyTheDistanceAreNear) {
  const mesh::ClothMesh mesh = sheet(4, 0.5);
  KdopHierarchy hierarchy = hierarchyOver(mesh);
  std::vector<NearElement> found;
  const Cursor above = Cursor::point({0.25, 0.25, 0.125});  // a particle below it in six triangles
  hierarchy.query(above, {0.125}, found);
  const std::size_t touching = found.size();
  EXPECT_GE(touching, 4u);
  for (const NearElement& element : found) EXPECT_EQ(element.distance, 0.125);
  hierarchy.query(above, {std::nextafter(0.125, 0.0)}, found);
  EXPECT_TRUE(found.empty());
  hierarchy.query(above, {0.125, touching - 1}, found);
  ASSERT_EQ(found.size(), touching - 1);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LT(found[i - 1].triangle, found[i].triangle);
  }
}

TEST(KdopHierarchy, SignedDistanceTellsHowDeepAnElementIsInTheCursor) {
  KdopHierarchy hierarchy({{0, 1, 2}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  std::vector<NearElement> found;
  hierarchy.query(Cursor::spheres({{{0.25, 0.25, 0.5}, 0.125}, {{0.25, 0.25, -0.5}, 0.75}}), {},
                  found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].distance, -0.25);
  EXPECT_EQ(found[0].part, 1);
  EXPECT_EQ(found[0].point, Vector3d(0.25, 0.25, 0.0));
  EXPECT_EQ(found[0].normal, Vector3d(0, 0, 1));
}

TEST(KdopHierarchy, NothingInRangeIsAnEmptyAnswer) {
  const mesh::ClothMesh mesh = sheet(8);
  const KdopHierarchy hierarchy = hierarchyOver(mesh);
  std::vector<NearElement> found(3);
  hierarchy.query(Cursor::point({0.1, 0.1, 0.1}), {0.05}, found);
  EXPECT_TRUE(found.empty());
  found.resize(3);
  hierarchy.query(Cursor::point({0.1, 0.1, 0.0}), {1.0, 0}, found);
  EXPECT_TRUE(found.empty());
  hierarchy.query(Cursor::point({1e9, -1e9, 1e9}), {1.0}, found);
  EXPECT_TRUE(found.empty());
}

TEST(KdopHierarchy, TrianglesWithoutAreaAreFoundLikeOthers) {
  const std::vector<Vector3d> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  KdopHierarchy hierarchy({{0, 1, 2}, {0, 0, 0}, {0, 1, 3}, {1, 2, 1}}, positions);
  std::vector<NearElement> found;
  hierarchy.query(Cursor::point({1.5, 0.0, 0.25}), {0.25}, found);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].triangle, 0);
  EXPECT_EQ(found[1].triangle, 3);
  EXPECT_EQ(found[0].normal, Vector3d::Zero());
  EXPECT_EQ(found[0].point, Vector3d(1.5, 0, 0));
}

TEST(KdopHierarchy, LeafHoldsEverythingIfItMay) {
  const mesh::ClothMesh mesh = sheet(2);
  HierarchySettings settings;
  settings.triangles_per_leaf = 1000;
  const KdopHierarchy hierarchy = hierarchyOver(mesh, settings);
  EXPECT_EQ(hierarchy.levels(), 1);
  std::vector<NearElement> found;
  hierarchy.query(Cursor::point({0, 0, 0}), {}, found);
  EXPECT_EQ(found.size(), mesh.triangles.size());
}

TEST(KdopHierarchy, RefusesMeshesThatAreNone) {
  const std::vector<Vector3d> positions(3, Vector3d::Zero());
  using Triangles = std::vector<std::array<int, 3>>;
  EXPECT_EQ(refusalOf([&] { KdopHierarchy(Triangles{}, positions); }),
            "a hierarchy needs at least one triangle");
  EXPECT_EQ(refusalOf([&] {
              KdopHierarchy(Triangles{{0, 1, 2}, {0, 3, 1}}, positions);
            }),
            "triangle 1 has vertex 3: must be from 0 to 2");
  EXPECT_EQ(refusalOf([&] {
              KdopHierarchy(Triangles{{0, -1, 2}}, positions);
            }),
            "triangle 0 has vertex -1: must be from 0 to 2");
  EXPECT_EQ(refusalOf([&] {
              KdopHierarchy(Triangles{{0, 1, 2}}, positions, {KdopKind::k6, 0});
            }),
            "triangles_per_leaf 0: must be >= 1");
}

TEST(KdopHierarchy, RefusedPositionsLeaveItAsItWas) {
  const mesh::ClothMesh mesh = sheet(8);
  KdopHierarchy hierarchy = hierarchyOver(mesh);
  const std::vector<Vector3d> good = restPositions(mesh);
  EXPECT_EQ(refusalOf([&] {
              hierarchy.refit({good.begin(), good.end() - 1});
            }),
            "80 positions for a hierarchy over 81 vertices");
  for (double bad : {kNaN, kInfinity, -kInfinity, 1.5e9}) {
    std::vector<Vector3d> positions(good.size(), Vector3d(7, 7, 7));
    positions.back().y() = bad;
    EXPECT_NE(refusalOf([&] { hierarchy.refit(positions); }).find("position 80 (7, "),
              std::string::npos);
  }
  std::vector<NearElement> found;
  const Cursor cursor = Cursor::point({0.1, 0.1, 0.01});
  hierarchy.query(cursor, {0.02}, found);
  expectSame(found, nearElementsByBruteForce(mesh.triangles, good, cursor, {0.02}), "as before");
  EXPECT_FALSE(found.empty());
}

TEST(KdopHierarchy, RefusesDistancesThatAreNone) {
  const KdopHierarchy hierarchy({{0, 1, 2}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  std::vector<NearElement> found;
  const Cursor cursor = Cursor::point({0, 0, 0});
  EXPECT_EQ(refusalOf([&] { hierarchy.query(cursor, {-0.5}, found); }),
            "distance of a proximity query -0.5 m: must be >= 0");
  EXPECT_NE(refusalOf([&] { hierarchy.query(cursor, {kNaN}, found); }).find("nan m: must be >= 0"),
            std::string::npos);
}

TEST(KdopHierarchy, HasNoVolumesBeyondItsLevels) {
  const KdopHierarchy hierarchy = hierarchyOver(sheet(8));
  EXPECT_NO_THROW(hierarchy.volume(hierarchy.levels() - 1, 0));
  EXPECT_THROW(hierarchy.volume(hierarchy.levels(), 0), std::out_of_range);
  EXPECT_THROW(hierarchy.volume(-1, 0), std::out_of_range);
  EXPECT_THROW(hierarchy.volume(1, 2), std::out_of_range);
  EXPECT_THROW(hierarchy.volume(1, -1), std::out_of_range);
}

}  // namespace
}  // namespace haptex::proximity::test_kdop_hierarchy
