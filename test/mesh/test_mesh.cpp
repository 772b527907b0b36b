#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "../refusal.h"
#include "haptex/mesh/circles.h"
#include "haptex/mesh/mesh.h"

namespace haptex::mesh::test_mesh {
namespace {

double totalArea(const ClothMesh& mesh) {
  double area = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector2d ab =
        mesh.rest_coordinates[triangle[1]] - mesh.rest_coordinates[triangle[0]];
    const Eigen::Vector2d ac =
        mesh.rest_coordinates[triangle[2]] - mesh.rest_coordinates[triangle[0]];
    area += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  return area;
}

TEST(Mesh, RectangleCoversItsAreaWithEquallyOrientedTriangles) {
  for (Triangulation triangulation : {Triangulation::kOneWay, Triangulation::kAlternating}) {
    const ClothMesh mesh = makeRectangle(0.3, 0.2, 7, 5, triangulation);
    EXPECT_EQ(mesh.triangles.size(), 2u * 7u * 5u);
    EXPECT_EQ(mesh.rest_coordinates.size(), 8u * 6u);
    EXPECT_NEAR(totalArea(mesh), 0.3 * 0.2, 1e-15);  // signed: a flipped triangle would show
    EXPECT_TRUE(findDefects(mesh).none());
  }
}

TEST(Mesh, DiagonalsAreOneWayOrAlternate) {
  const auto diagonals = [](Triangulation triangulation) {
    const ClothMesh mesh = makeRectangle(1.0, 1.0, 2, 2, triangulation);
    std::set<std::set<int>> edges;
    for (const auto& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    }
    // Cells (0,0), (1,0): rising diagonals 0-4 and 1-5, falling 1-3 and 2-4.
    return std::vector<bool>{edges.count({0, 4}) > 0, edges.count({1, 5}) > 0,
                             edges.count({1, 3}) > 0, edges.count({2, 4}) > 0};
  };
  EXPECT_EQ(diagonals(Triangulation::kOneWay), (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(diagonals(Triangulation::kAlternating), (std::vector<bool>{true, false, false, true}));
}

TEST(Mesh, SampleHangsBelowTheWorldOrigin) {
  const ClothMesh mesh = makeRectangle(0.2, 0.4, 2, 2, Triangulation::kOneWay);
  EXPECT_TRUE(mesh.initial_positions[7].isZero());  // middle of the top edge
  EXPECT_TRUE(mesh.initial_positions[0].isApprox(Eigen::Vector3d(0.0, -0.1, -0.4)));
}

TEST(Mesh, SidesAreTheParticlesAtTheExtremesOfTheRestCoordinates) {
  const ClothMesh mesh = makeRectangle(0.2, 0.4, 2, 2, Triangulation::kOneWay);
  EXPECT_EQ(sideParticles(mesh, Side::kBottom), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(sideParticles(mesh, Side::kTop), (std::vector<int>{6, 7, 8}));
  EXPECT_EQ(sideParticles(mesh, Side::kLeft), (std::vector<int>{0, 3, 6}));
  EXPECT_EQ(sideParticles(mesh, Side::kRight), (std::vector<int>{2, 5, 8}));
}

struct BadRectangle {
  double width, height;
  int cells_u, cells_v;
  const char* named;
};

class RefusedRectangle : public testing::TestWithParam<BadRectangle> {};

TEST_P(RefusedRectangle, NamesTheParameter) {
  const BadRectangle& bad = GetParam();
  try {
    makeRectangle(bad.width, bad.height, bad.cells_u, bad.cells_v, Triangulation::kOneWay);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(bad.named), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Mesh, RefusedRectangle,
                         testing::Values(BadRectangle{0.0, 0.2, 1, 1, "width is 0"},
                                         BadRectangle{std::numeric_limits<double>::quiet_NaN(), 0.2,
                                                      1, 1, "width is"},
                                         BadRectangle{0.2, -1.0, 1, 1, "height is -1"},
                                         BadRectangle{0.2, 0.2, 0, 1, "cells_u is 0"},
                                         BadRectangle{0.2, 0.2, 1, -3, "cells_v is -3"}));

ClothMesh twoTriangles() { return makeRectangle(1.0, 1.0, 1, 1, Triangulation::kOneWay); }

TEST(MeshDefects, ReportsDegenerateTrianglesByIndex) {
  ClothMesh mesh = twoTriangles();
  mesh.triangles.push_back({0, 0, 1});          // a repeated particle
  mesh.rest_coordinates.push_back({2.0, 0.0});  // on the line through 0 and 1
  mesh.initial_positions.push_back({0.0, 2.0, 0.0});
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_EQ(findDefects(mesh).degenerate_triangles, (std::vector<int>{2, 3}));
}

TEST(MeshDefects, ReportsDuplicateTrianglesWhateverTheirOrder) {
  ClothMesh mesh = twoTriangles();
  mesh.triangles.push_back({mesh.triangles[0][2], mesh.triangles[0][0], mesh.triangles[0][1]});
  EXPECT_EQ(findDefects(mesh).duplicate_triangles, std::vector<int>{2});
}

TEST(MeshDefects, ReportsUnreferencedAndNonFiniteParticles) {
  ClothMesh mesh = twoTriangles();
  mesh.rest_coordinates.push_back({5.0, 5.0});
  mesh.initial_positions.push_back({0.0, 0.0, std::numeric_limits<double>::infinity()});
  const MeshDefects defects = findDefects(mesh);
  EXPECT_EQ(defects.unreferenced_particles, std::vector<int>{4});
  EXPECT_EQ(defects.non_finite_particles, std::vector<int>{4});
}

TEST(MeshDefects, ReportsParticlesThatDoNotExist) {
  ClothMesh mesh = twoTriangles();
  mesh.triangles.push_back({0, 1, 99});
  mesh.triangles.push_back({-1, 1, 2});
  EXPECT_EQ(findDefects(mesh).invalid_triangles, (std::vector<int>{2, 3}));
}

TEST(MeshDefects, RequireSoundNamesKindAndIndex) {
  ClothMesh mesh = twoTriangles();
  mesh.triangles.push_back({0, 0, 1});
  try {
    requireSound(mesh);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "degenerate triangles: 2");
  }
  EXPECT_THROW(requireSound({}), std::invalid_argument);
  EXPECT_NO_THROW(requireSound(twoTriangles()));
}

TEST(Disc, IsSoundRoundAndOfNearlyEqualTriangles) {
  constexpr int kRings = 24;
  const ClothMesh mesh = makeDisc(0.127, kRings);
  EXPECT_TRUE(findDefects(mesh).none());
  double area = 0.0, least = 1.0, most = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector2d& a = mesh.rest_coordinates[triangle[0]];
    const Eigen::Vector2d ab = mesh.rest_coordinates[triangle[1]] - a;
    const Eigen::Vector2d ac = mesh.rest_coordinates[triangle[2]] - a;
    const double own = 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
    area += own;
    least = std::min(least, own);
    most = std::max(most, own);
  }
  // All lie counter-clockwise; the edge is a polygon of 131 sides, which has 4e-4 less than the
  // disc.
  EXPECT_GT(least, 0.0);
  EXPECT_NEAR(area, M_PI * 0.127 * 0.127, 5e-4 * area);
  EXPECT_LT(most, 1.5 * least);
  // Euler: V - E + F = 1 with 3 F = 2 E - rim.
  const int rim = static_cast<int>(std::lround(M_PI * std::sqrt(3.0) * kRings));
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.rest_coordinates.size() - 2 - rim);
  EXPECT_THROW(makeDisc(-1.0, 3), std::invalid_argument);
  EXPECT_THROW(makeDisc(1.0, 0), std::invalid_argument);
}

TEST(Circles, MakeASoundRingOfTrianglesAsHighAsTheCirclesAreApart) {
  const std::vector<double> radii = {0.05, 0.052, 0.055, 0.06, 0.068, 0.08};
  const ClothMesh mesh = meshOfCircles(radii);
  EXPECT_TRUE(findDefects(mesh).none());
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector2d ab = mesh.rest_coordinates[b] - mesh.rest_coordinates[a];
    const Eigen::Vector2d ac = mesh.rest_coordinates[c] - mesh.rest_coordinates[a];
    const double own = 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
    EXPECT_GT(own, 0.0);
    area += own;
  }
  const auto sides = [&](std::size_t circle, std::size_t other) {
    return std::lround(M_PI * std::sqrt(3.0) * radii[circle] /
                       std::abs(radii[circle] - radii[other]));
  };
  const long inner = sides(0, 1), outer = sides(5, 4);
  const auto polygon = [](double radius, long count) {
    return 0.5 * count * radius * radius * std::sin(2.0 * M_PI / count);
  };
  EXPECT_NEAR(area, polygon(radii[5], outer) - polygon(radii[0], inner), 1e-12 * area);
  // A hole: V - E + F = 0 with 3 F = 2 E - both rims.
  const auto rims = static_cast<std::size_t>(inner + outer);
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.rest_coordinates.size() - rims);
}

TEST(Circles, RefuseRadiiThatDoNotAscend) {
  const auto refusal = [](const std::vector<double>& radii) -> std::string {
    return test::refusalOf([&] { meshOfCircles(radii); });
  };
  EXPECT_EQ(refusal({0.1}), "a round mesh has 1 circles: allowed are 2 or more");
  EXPECT_EQ(refusal({-0.1, 0.2}),
            "radius 0 of a round mesh is -0.1 m: allowed are finite numbers >= 0");
  EXPECT_EQ(refusal({0.1, 0.1}),
            "radius 1 of a round mesh is 0.1 m: allowed are finite numbers > 0.1");
  EXPECT_EQ(refusal({0.0, std::nan("")}),
            "radius 1 of a round mesh is nan m: allowed are finite numbers > 0");
  EXPECT_EQ(refusal({0.0, INFINITY}),
            "radius 1 of a round mesh is inf m: allowed are finite numbers > 0");
}

TEST(CutAsInSpace, GivesEveryTriangleTheEdgesThatItHasThere) {
  ClothMesh mesh;
  mesh.initial_positions = {{0.0, 0.0, 0.0}, {0.3, 0.1, 0.2}, {-0.1, 0.4, 0.1}, {0.2, 0.1, -0.3}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  cutAsInSpace(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<Eigen::Vector2d, 3> corners = mesh.restCorners(t);
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const double length = (mesh.initial_positions[mesh.triangles[t][next]] -
                             mesh.initial_positions[mesh.triangles[t][i]])
                                .norm();
      EXPECT_NEAR((corners[next] - corners[i]).norm(), length, 1e-15) << t;
    }
    EXPECT_EQ(corners[1].y(), 0.0);
    EXPECT_GT(corners[2].y(), 0.0);
  }
}

}  // namespace
}  // namespace haptex::mesh::test_mesh
