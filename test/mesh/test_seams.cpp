#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "../refusal.h"
#include "haptex/mesh/seam.h"
#include "haptex/mesh/ties.h"

namespace haptex::mesh::test_seams {
namespace {

using test::refusalOf;

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Rectangles beside each other, each with its cells along the seams v, as panels 0, 1, ...
ClothMesh strips(const std::vector<int>& cells) {
  ClothMesh mesh;
  for (std::size_t p = 0; p < cells.size(); ++p) {
    const ClothMesh strip = makeRectangle(0.1, 0.2, 1, cells[p], Triangulation::kOneWay);
    const int before = static_cast<int>(mesh.rest_coordinates.size());
    for (const Vector2d& rest : strip.rest_coordinates) {
      mesh.rest_coordinates.push_back(rest);
      mesh.initial_positions.emplace_back(rest.x() + 0.1 * static_cast<double>(p), rest.y(), 0.0);
    }
    for (const auto& [a, b, c] : strip.triangles) {
      mesh.triangles.push_back({a + before, b + before, c + before});
      mesh.triangle_panels.push_back(static_cast<int>(p));
    }
    mesh.panels.push_back({});
  }
  return mesh;
}

/// The particles of a strip at u = 0 or 1, upwards. @param first the strip's first particle
std::vector<int> side(int first, int cells, int u) {
  std::vector<int> particles;
  for (int i = 0; i <= cells; ++i) particles.push_back(first + 2 * i + u);
  return particles;
}

double restArea(const ClothMesh& mesh) {
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.restCorners(t);
    const Vector2d ab = b - a, ac = c - a;
    area += 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  }
  return area;
}

TEST(ResolvedTies, OfAChainAreThoseOfItsFreeEnds) {
  const std::vector<ResolvedTie> resolved =
      resolveTies({{4, {3, 0}, 0.5}, {3, {0, 1}, 0.25}, {5, {4, 2}, 0.0}}, 6);
  ASSERT_EQ(resolved.size(), 3u);
  EXPECT_EQ(resolved[0].particle, 3);
  ASSERT_EQ(resolved[1].shares.size(), 2u);
  EXPECT_EQ(resolved[1].shares[0].particle, 0);
  EXPECT_EQ(resolved[1].shares[0].weight, 0.5 * 0.75 + 0.5);
  EXPECT_EQ(resolved[1].shares[1].weight, 0.5 * 0.25);
  EXPECT_EQ(resolved[2].shares[1].weight, 0.5 * 0.25);
}

TEST(ResolvedTies, RefuseWhatHasNoPlace) {
  const auto refusal = [](const std::vector<Tie>& ties) {
    return refusalOf([&] { resolveTies(ties, 4); });
  };
  EXPECT_NE(refusal({{0, {1, 2}, 0.5}, {1, {3, 0}, 0.5}}).find("tied to itself"),
            std::string::npos);
  EXPECT_NE(refusal({{0, {0, 2}, 0.5}}).find("particle 0 is tied to itself"), std::string::npos);
  EXPECT_NE(refusal({{0, {1, 1}, 0.5}}).find("must differ"), std::string::npos);
  EXPECT_NE(refusal({{0, {1, 4}, 0.5}}).find("particles 0 to 3"), std::string::npos);
  EXPECT_NE(refusal({{0, {1, 2}, 1.5}}).find("share 1.5; it must lie from 0 to 1"),
            std::string::npos);
  EXPECT_NE(refusal({{0, {1, 2}, std::nan("")}}).find("nan"), std::string::npos);
  EXPECT_NE(refusal({{0, {1, 2}, 0.5}, {0, {1, 3}, 0.5}}).find("tied twice"), std::string::npos);
  EXPECT_EQ(refusal({{0, {1, 2}, 0.5}, {3, {0, 2}, 1.0}}), test::kNotRefused);
}

TEST(Sewing, TiesTheFinerEdgeToThePlacesBesideIt) {
  ClothMesh mesh = strips({4, 6});
  sew(mesh, {{side(0, 4, 1), side(10, 6, 0)}});
  ASSERT_EQ(mesh.ties.size(), 7u);
  for (const ResolvedTie& tie : resolveTies(mesh.ties, mesh.rest_coordinates.size())) {
    EXPECT_GE(tie.particle, 10);
    Vector3d place = Vector3d::Zero();
    for (const TieShare& share : tie.shares) {
      place += share.weight * mesh.initial_positions[share.particle];
    }
    EXPECT_LT((place - mesh.initial_positions[tie.particle]).norm(), 1e-16);
  }
  // Pieces of 1/4 and of 1/6 have 8 pairs beside each other, and a length of 0.2 m in all.
  ASSERT_EQ(mesh.seam_hinges.size(), 8u);
  double length = 0.0;
  for (const SeamHinge& hinge : mesh.seam_hinges) {
    length += hinge.length;
    EXPECT_LT((hinge.along[0] - Vector2d(0.0, 1.0)).norm(), 1e-15);
    EXPECT_LT((hinge.along[1] - Vector2d(0.0, 1.0)).norm(), 1e-15);
    EXPECT_LT((hinge.inward[0] - Vector2d(-1.0, 0.0)).norm(), 1e-15);
    EXPECT_LT((hinge.inward[1] - Vector2d(1.0, 0.0)).norm(), 1e-15);
  }
  EXPECT_NEAR(length, 0.2, 1e-15);
}

/// Four squares around a point, sewn to each other in a circle.
TEST(Sewing, OfSeamsThatMeetInAPointLeavesOneParticleFree) {
  ClothMesh mesh = strips({1, 2, 3, 1});
  // Of strip p the corners at v = 0 are first and first + 1; sides run from there.
  const std::vector<int> first = {0, 4, 10, 18};
  const std::vector<int> cells = {1, 2, 3, 1};
  std::vector<Seam> seams;
  for (int p = 0; p < 4; ++p) {
    const int next = (p + 1) % 4;
    // The strip's bottom goes from the point to its right corner: the next strip's left side.
    seams.push_back({{first[p], first[p] + 1}, side(first[next], cells[next], 0)});
  }
  sew(mesh, seams);
  const std::vector<ResolvedTie> resolved = resolveTies(mesh.ties, mesh.rest_coordinates.size());
  int tied = 0;
  for (const ResolvedTie& tie : resolved) {
    if (std::find(first.begin(), first.end(), tie.particle) == first.end()) continue;
    ++tied;
    ASSERT_EQ(tie.shares.size(), 1u);
    EXPECT_NE(std::find(first.begin(), first.end(), tie.shares[0].particle), first.end());
  }
  EXPECT_EQ(tied, 3);
}

TEST(Sewing, OfADartBeginsAtItsTip) {
  // Two triangles beside each other that share particle 0: the sides are 0-2 and 0-3.
  ClothMesh mesh;
  mesh.rest_coordinates = {{0, 0}, {-1, 0.2}, {-0.1, 1}, {0.1, 1}, {1, 0.2}};
  for (const Vector2d& rest : mesh.rest_coordinates) {
    mesh.initial_positions.emplace_back(rest.x(), rest.y(), 0.0);
  }
  mesh.triangles = {{0, 2, 1}, {0, 4, 3}};
  sew(mesh, {{{0, 2}, {0, 3}}});
  ASSERT_EQ(mesh.ties.size(), 1u);
  EXPECT_EQ(mesh.ties[0].particle, 3);
}

TEST(Sewing, RefusesWhatNoSeamCanBe) {
  const ClothMesh mesh = strips({4, 6});
  const auto refusal = [&](const Seam& seam) {
    const std::string sewn = refusalOf([&] {
      ClothMesh copy = mesh;
      sew(copy, {seam});
    });
    EXPECT_EQ(refusalOf([&] { merge(mesh, {seam}); }) == test::kNotRefused,
              sewn == test::kNotRefused);
    return sewn;
  };
  const Seam sound = {side(0, 4, 1), side(10, 6, 0)};
  EXPECT_EQ(refusal(sound), test::kNotRefused);
  EXPECT_NE(refusal({{1}, sound.second}).find("has 1 particles"), std::string::npos);
  EXPECT_NE(refusal({{1, 5}, sound.second}).find("no edge of a triangle"), std::string::npos);
  EXPECT_NE(refusal({{0, 3}, sound.second}).find("edge of two triangles"), std::string::npos);
  Seam seam = sound;
  seam.first_places = {0.0, 0.2, 0.1, 0.5, 1.0};
  EXPECT_NE(refusal(seam).find("must ascend from 0 to 1"), std::string::npos);
  seam.first_places = {0.0, 1.0};
  EXPECT_NE(refusal(seam).find("2 places for 5 particles"), std::string::npos);
  seam = sound;
  seam.angle = M_PI;
  EXPECT_NE(refusal(seam).find("below pi"), std::string::npos);
}

/// As where a lining is sewn into a seam.
TEST(Sewing, OfThreeEdgesTiesEachOnce) {
  ClothMesh mesh = strips({6, 4, 5});
  const Seam to_second = {side(0, 6, 1), side(14, 4, 0)},
             to_third = {side(0, 6, 1), side(24, 5, 0)};
  const Seam between = {side(14, 4, 0), side(24, 5, 0)};
  ClothMesh copy = mesh;
  sew(copy, {to_second, to_third});
  EXPECT_EQ(resolveTies(copy.ties, mesh.rest_coordinates.size()).size(), 7u + 6u);
  EXPECT_NE(refusalOf([&] {
              sew(mesh, {to_second, to_third, between});
            }).find("is tied to itself"),
            std::string::npos);
  EXPECT_TRUE(mesh.ties.empty());
}

TEST(Merging, OfAnUnmatchedSeamIsOneMeshWithTheParticlesOfBoth) {
  const ClothMesh mesh = strips({4, 6});
  const MergedMesh merged = merge(mesh, {{side(0, 4, 1), side(10, 6, 0)}});
  // Places of quarters and of sixths: 0, 1/6, 1/4, 1/3, 1/2, 2/3, 3/4, 5/6, 1.
  EXPECT_EQ(merged.mesh.rest_coordinates.size(), mesh.rest_coordinates.size() - 12u + 9u);
  EXPECT_EQ(merged.mesh.triangles.size(), mesh.triangles.size() + 4u + 2u);
  EXPECT_TRUE(findDefects(merged.mesh).none()) << findDefects(merged.mesh).description();
  EXPECT_NEAR(restArea(merged.mesh), restArea(mesh), 1e-16);
  EXPECT_EQ(merged.mesh.seam_hinges.size(), 8u);
  for (int end = 0; end < 2; ++end) {
    const int left = end == 0 ? 1 : 9, right = end == 0 ? 10 : 22;
    EXPECT_EQ(merged.particles[left], merged.particles[right]);
  }
  for (std::size_t i = 0; i < mesh.initial_positions.size(); ++i) {
    EXPECT_LT(
        (merged.mesh.initial_positions[merged.particles[i]] - mesh.initial_positions[i]).norm(),
        1e-16);
  }
  EXPECT_EQ(merged.mesh.ties.size(), 0u);
  ClothMesh sewn = mesh;
  sew(sewn, {{side(0, 4, 1), side(10, 6, 0)}});
  EXPECT_NE(refusalOf([&] { merge(sewn, {}); }).find("has 7 ties and 8 hinges"), std::string::npos);
}

TEST(Merging, RefusesASeamThatClosesATriangle) {
  ClothMesh mesh;
  mesh.rest_coordinates = {{0, 0}, {1, 0}, {0, 1}};
  mesh.initial_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_NE(refusalOf([&] {
              merge(mesh, {{{0, 1}, {0, 2}}});
            }).find("may not close a triangle"),
            std::string::npos);
}

}  // namespace
}  // namespace haptex::mesh::test_seams
