// Garments with edges half as long: the same panels, and the same surface in space.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "haptex/garment/garment_mesh.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/garment/triangulation/threads.h"

namespace haptex::garment::test_halved_garment {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

GarmentMesh shirt() {
  return makeGarmentMesh(loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/shirt.yaml"), 0.04);
}

double restArea(const GarmentMesh& garment) {
  double area = 0.0;
  for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
    const auto [a, b, c] = garment.mesh.restCorners(t);
    const Vector2d ab = b - a, ac = c - a;
    area += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  return area;
}

double areaInSpace(const GarmentMesh& garment) {
  const auto& at = garment.mesh.initial_positions;
  double area = 0.0;
  for (const auto& [a, b, c] : garment.mesh.triangles) {
    area += 0.5 * (at[b] - at[a]).cross(at[c] - at[a]).norm();
  }
  return area;
}

double patternArea(const Pattern& pattern) {
  double area = 0.0;
  for (const Panel& panel : pattern.panels) area += areaOf(panel);
  return area;
}

/// m, of particles of an outline from its curves at the most.
double farthestFromCurves(const GarmentMesh& garment) {
  double farthest = 0.0;
  for (std::size_t p = 0; p < garment.edges.size(); ++p) {
    const Panel& panel = garment.pattern.panels[p];
    const Threads threads(panel);
    for (std::size_t k = 0; k < garment.edges[p].size(); ++k) {
      for (std::size_t e = 0; e < garment.edges[p][k].size(); ++e) {
        const Curve& curve = panel.outlines[k][e].curve;
        const EdgeParticles& edge = garment.edges[p][k][e];
        for (std::size_t i = 0; i < edge.particles.size(); ++i) {
          const Vector2d at = threads.pointOf(garment.mesh.rest_coordinates[edge.particles[i]]);
          const double off = (at - curve.at(curve.parameterAt(edge.lengths[i]))).norm();
          farthest = std::max(farthest, off);
        }
      }
    }
  }
  return farthest;
}

TEST(HalvedGarment, IsOfSoundPanelsWithFourTrianglesForEach) {
  const GarmentMesh coarse = shirt();
  const GarmentMesh fine = halved(coarse);
  EXPECT_NO_THROW(mesh::requireSound(fine.mesh));
  ASSERT_EQ(fine.mesh.triangles.size(), 4 * coarse.mesh.triangles.size());
  for (std::size_t t = 0; t < fine.mesh.triangles.size(); ++t) {
    EXPECT_EQ(fine.mesh.panelOf(t), coarse.mesh.panelOf(t / 4));
    EXPECT_EQ(fine.mesh.fabricOf(t), coarse.mesh.fabricOf(t / 4));
    const auto [a, b, c] = fine.mesh.restCorners(t);
    const Vector2d ab = b - a, ac = c - a;
    EXPECT_GT(ab.x() * ac.y() - ab.y() * ac.x(), 0.0);
  }
}

/// The middles of edges, whatever the panels' places: a triangle's parts lie in its plane.
TEST(HalvedGarment, IsTheSameSurfaceInSpace) {
  GarmentMesh coarse = shirt();
  for (Vector3d& place : coarse.mesh.initial_positions) {
    place = {place.x() + std::sin(9.0 * place.y()), std::cos(7.0 * place.z()), place.z()};
  }
  const GarmentMesh fine = halved(coarse);
  EXPECT_NEAR(areaInSpace(fine), areaInSpace(coarse), 1e-12 * areaInSpace(coarse));
  for (std::size_t t = 0; t < fine.mesh.triangles.size(); ++t) {
    std::array<Vector3d, 3> old;
    for (int i = 0; i < 3; ++i) {
      old[i] = coarse.mesh.initial_positions[coarse.mesh.triangles[t / 4][i]];
    }
    const Vector3d normal = (old[1] - old[0]).cross(old[2] - old[0]).normalized();
    for (const int corner : fine.mesh.triangles[t]) {
      EXPECT_LT(std::abs(normal.dot(fine.mesh.initial_positions[corner] - old[0])), 1e-14);
    }
  }
}

/// Straight edges between points of a curve leave out what falls to a quarter if there are twice as
/// many of them.
TEST(HalvedGarment, FollowsTheCurvesOfThePattern) {
  const GarmentMesh coarse = shirt(), fine = halved(coarse), finest = halved(fine);
  EXPECT_LT(farthestFromCurves(finest), 1e-9);
  const double whole = patternArea(coarse.pattern);
  const double before = std::abs(whole - restArea(coarse));
  EXPECT_LT(std::abs(whole - restArea(fine)), 0.3 * before);
  EXPECT_LT(std::abs(whole - restArea(finest)), 0.08 * before);
}

TEST(HalvedGarment, IsSewnWhereItWas) {
  const GarmentMesh coarse = shirt(), fine = halved(coarse);
  ASSERT_EQ(fine.seams.size(), coarse.seams.size());
  for (std::size_t s = 0; s < fine.seams.size(); ++s) {
    EXPECT_EQ(fine.seams[s].first.size(), 2 * coarse.seams[s].first.size() - 1);
    EXPECT_EQ(fine.seams[s].second.size(), 2 * coarse.seams[s].second.size() - 1);
  }
  // One particle for two, and no triangle cut: both sides meet as they did.
  const auto merged = mesh::merge(fine.mesh, fine.seams);
  const auto before = mesh::merge(coarse.mesh, coarse.seams);
  EXPECT_EQ(merged.mesh.triangles.size() == fine.mesh.triangles.size(),
            before.mesh.triangles.size() == coarse.mesh.triangles.size());
}

/// A lens whose curves leave its corners at 5 degrees: with both on their curves the triangles
/// there would be turned inside out or nearly so.
TEST(HalvedGarment, KeepsTrianglesBesideSharpCornersUpright) {
  const Pattern lens = parsePattern(R"(
source: drawn for a test
panels:
  - name: lens
    fabric: wool
    outline:
      - {quadratic: [[0, 0], [0.3, 0.2], [0.6, 0.05]]}
      - {quadratic: [[0.6, 0.05], [0.3, 0.28], [0, 0]]}
)",
                                    "lens");
  GarmentMesh garment = makeGarmentMesh(lens, 0.1);
  for (int i = 0; i < 3; ++i) {
    garment = halved(garment);
    EXPECT_NO_THROW(mesh::requireSound(garment.mesh));
    for (std::size_t t = 0; t < garment.mesh.triangles.size(); ++t) {
      const auto [a, b, c] = garment.mesh.restCorners(t);
      const Vector2d ab = b - a, ac = c - a;
      EXPECT_GT(ab.x() * ac.y() - ab.y() * ac.x(), 0.0);
    }
  }
}

}  // namespace
}  // namespace haptex::garment::test_halved_garment
