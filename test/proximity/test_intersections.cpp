#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <random>
#include <string>

#include "exact_distance.h"
#include "fixtures.h"
#include "haptex/base/workload.h"
#include "haptex/proximity/exact_number.h"
#include "haptex/proximity/exact_orientation.h"
#include "haptex/proximity/intersections.h"
#include "haptex/proximity/mesh_intersections.h"

namespace haptex::proximity::test_intersections {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

// Smallest distance that two triangles with corners on the grid below may have is some 1e-3.
constexpr double kApart = 1e-6;

class GridCorners {
 public:
  explicit GridCorners(int reach) : number_(-reach, reach) {}
  /// Whole even numbers, so that middles are whole, too.
  Vector3d next() {
    const double x = number_(generator_), y = number_(generator_), z = number_(generator_);
    return 2.0 * Vector3d(x, y, z);
  }

 private:
  std::mt19937 generator_{3};
  std::uniform_int_distribution<int> number_;
};

bool touch(const Positions& first, const Positions& second) {
  return exactDistance<long double>(first, second) < kApart;
}

TEST(ExactNumber, KeepsWhatDoublesRoundAway) {
  const ExactNumber small(1e-40), large(1e40);
  EXPECT_EQ((large + small - large - small).sign(), 0);
  EXPECT_EQ((large + small - large).rounded(), 1e-40);
  EXPECT_EQ(((large + small) * (large - small) - large * large + small * small).sign(), 0);
  EXPECT_EQ((ExactNumber(0.1) * 3.0 - 0.3).sign(), 1) << "0.1 is a little above a tenth";
  EXPECT_EQ((-ExactNumber(0.1)).sign(), -1);
}

TEST(Orientation, IsExactWhereDoublesAreUndecided) {
  // Four points of the plane x + y + z = 1/2, with coordinates that are not rounded, far apart and
  // near the origin, and one that is moved by the least that a double can be moved.
  const Vector3d a(0.5, 0, 0), b(0, 0.5, 0), c(0, 0, 0.5);
  for (const Vector3d& d : {Vector3d(0.25, 0.25, 0.0), Vector3d(12.0, -11.5, 0.0),
                            Vector3d(12.0, 12.0, -23.5), Vector3d(0.125, 0.25, 0.125)}) {
    EXPECT_EQ(orientation(a, b, c, d), 0);
    const Vector3d above(d.x(), std::nextafter(d.y(), 1e9), d.z());
    const Vector3d below(d.x(), std::nextafter(d.y(), -1e9), d.z());
    EXPECT_EQ(orientation(a, b, c, above), 1);
    EXPECT_EQ(orientation(a, b, c, below), -1);
    EXPECT_EQ(orientation(b, a, c, above), -1);
  }
}

TEST(Intersections, OfTrianglesApartAgreeWithTheDistance) {
  int meeting = 0;
  constexpr int kCases = base::unlessSanitized(20000, 4000);
  for (int reach : {1, 2, 4}) {
    GridCorners corners(reach);
    for (int i = 0; i < kCases; ++i) {
      Positions p(6);
      for (Vector3d& corner : p) corner = corners.next();
      const bool expected = touch({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
      ASSERT_EQ(intersect(p, {0, 1, 2}, {3, 4, 5}), expected) << reach << ' ' << i;
      ASSERT_EQ(intersect(p, {5, 3, 4}, {2, 0, 1}), expected) << reach << ' ' << i;
      meeting += expected;
    }
  }
  EXPECT_GT(meeting, kCases / 2);
  EXPECT_LT(meeting, 5 * kCases / 2);
}

TEST(Intersections, OfTrianglesWithACommonCornerAreThoseElsewhere) {
  int meeting = 0, without_area = 0;
  constexpr int kCases = base::unlessSanitized(5000, 1000);
  for (int reach : {1, 2, 4}) {
    GridCorners corners(reach);
    for (int i = 0; i < kCases; ++i) {
      Positions p(5);
      for (Vector3d& corner : p) corner = corners.next();
      const auto area = [&](int a, int b) { return (p[a] - p[0]).cross(p[b] - p[0]).norm(); };
      if (area(1, 2) == 0.0 || area(3, 4) == 0.0) {
        ++without_area;
        continue;
      }
      // What they have in common beyond the corner reaches the outer half of one of them.
      const auto outer = [&](int a, int b) {
        return Positions{p[a], p[b], 0.5 * (p[0] + p[a]), 0.5 * (p[0] + p[b])};
      };
      const bool expected =
          touch(outer(1, 2), {p[0], p[3], p[4]}) || touch({p[0], p[1], p[2]}, outer(3, 4));
      ASSERT_EQ(intersect(p, {0, 1, 2}, {3, 0, 4}), expected) << reach << ' ' << i;
      ASSERT_EQ(intersect(p, {4, 3, 0}, {1, 2, 0}), expected) << reach << ' ' << i;
      meeting += expected;
    }
  }
  EXPECT_GT(meeting, kCases / 4);
  EXPECT_LT(without_area, 2 * kCases);
}

TEST(Intersections, OfTrianglesWithACommonEdgeAreOverlaps) {
  int meeting = 0;
  GridCorners corners(1);
  for (int i = 0; i < 20000; ++i) {
    Positions p(4);
    for (Vector3d& corner : p) corner = corners.next();
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const Vector3d other = (p[1] - p[0]).cross(p[3] - p[0]);
    if (normal.isZero() || other.isZero()) continue;
    const bool expected = normal.dot(p[3] - p[0]) == 0.0 && normal.dot(other) > 0.0;
    ASSERT_EQ(intersect(p, {0, 1, 2}, {1, 0, 3}), expected) << i;
    ASSERT_EQ(intersect(p, {3, 1, 0}, {2, 0, 1}), expected) << i;
    meeting += expected;
  }
  EXPECT_GT(meeting, 1000);
}

TEST(Intersections, OfTrianglesWithoutAreaAreThoseOfTheSegmentsThatTheyAre) {
  // On the x axis: a segment from -1 to 1, its middle, a point beyond, and a place beside it.
  const Positions p = {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {2, 0, 0},
                       {0, 1, 0}, {0, 1, 1},  {0, 0, 0}};
  EXPECT_FALSE(intersect(p, {0, 1, 2}, {0, 4, 5})) << "only the common corner";
  EXPECT_TRUE(intersect(p, {6, 1, 2}, {0, 4, 5})) << "the same place, but no common corner";
  EXPECT_TRUE(intersect(p, {0, 1, 2}, {0, 3, 4})) << "along the edge from 0 to 3";
  EXPECT_FALSE(intersect(p, {0, 0, 1}, {0, 3, 4})) << "the segment leads away";
  EXPECT_TRUE(intersect(p, {0, 2, 3}, {0, 2, 3})) << "the same triangle";
  EXPECT_FALSE(intersect(p, {0, 2, 1}, {0, 2, 4})) << "beyond the common edge there is one only";
  EXPECT_TRUE(intersect(p, {0, 3, 2}, {0, 2, 3})) << "the same triangle, turned";
}

TEST(Intersections, OfAThinGapAndAThinOverlapDiffer) {
  // A corner above a face by the least that there is, in it, and below it.
  const double up = 1.0 + std::numeric_limits<double>::epsilon();
  Positions p = {{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {1, 1, up}, {1, 1, 3}, {2, 1, 3}};
  EXPECT_FALSE(intersect(p, {0, 1, 2}, {3, 4, 5}));
  p[3].z() = 1.0;
  EXPECT_TRUE(intersect(p, {0, 1, 2}, {3, 4, 5}));
}

TEST(Intersections, OfSheetsAreCounted) {
  const mesh::ClothMesh mesh = sheet(6);
  const auto count = [&](const char* name) {
    return countIntersections(oracles::deformedSheet(mesh, name), mesh.triangles);
  };
  EXPECT_EQ(count("flat"), 0u);
  EXPECT_EQ(count("draped"), 0u);
  EXPECT_EQ(count("folded"), 0u);
  EXPECT_GE(count("folded_without_gap"), 36u) << "every triangle lies on one of the other layer";
  const std::size_t n = mesh.triangles.size();
  EXPECT_EQ(count("on_a_point"), [&] {
    std::size_t pairs = 0;  // those without a common corner; else nothing is elsewhere
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        bool shared = false;
        for (int a : mesh.triangles[i]) {
          for (int b : mesh.triangles[j]) shared = shared || a == b;
        }
        pairs += !shared;
      }
    }
    return pairs;
  }());
}

TEST(Intersections, SweepFindsWhatAllPairsHave) {
  const mesh::ClothMesh mesh = sheet(6);
  int states = 0;
  for (const auto& state : oracles::deformedSheets(mesh)) {
    if (base::kSanitized && states++ % 3 != 0) continue;
    std::vector<TrianglePair> expected;
    for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
      for (int j = i + 1; j < static_cast<int>(mesh.triangles.size()); ++j) {
        if (intersect(state.positions, mesh.triangles[i], mesh.triangles[j])) {
          expected.push_back({i, j});
        }
      }
    }
    EXPECT_EQ(intersectingTriangles(state.positions, mesh.triangles), expected) << state.name;
  }
}

TEST(Intersections, RefuseWhatIsNoMesh) {
  const Positions p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(countIntersections(p, {}), 0u);
  EXPECT_THROW(countIntersections(p, {{0, 1, 3}}), std::invalid_argument);
  EXPECT_THROW(countIntersections(p, {{0, 1, -1}}), std::invalid_argument);
  const double nan = std::nan("");
  try {
    countIntersections({{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("position 1"), std::string::npos) << error.what();
  }
}

TEST(MeshIntersections, AreThoseOfTheSweepWhileTheMeshMoves) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<std::array<int, 3>> triangles;
  std::vector<Eigen::Vector3d> positions(60);
  for (int i = 0; i + 2 < 60; ++i) triangles.push_back({i, i + 1, i + 2});
  for (Eigen::Vector3d& place : positions) place = {any(random), any(random), any(random)};
  MeshIntersections moving(triangles, positions);
  for (int move = 0; move < 5; ++move) {
    const auto expected = intersectingTriangles(positions, triangles);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(moving.find(positions), expected);
    for (Eigen::Vector3d& place : positions) place = {any(random), any(random), any(random)};
  }
}

}  // namespace
}  // namespace haptex::proximity::test_intersections
