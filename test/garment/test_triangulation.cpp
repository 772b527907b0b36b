#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "garment_fixtures.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/base/workload.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/garment/triangulation/refinement.h"
#include "haptex/garment/triangulation/triangle_quality.h"

namespace haptex::garment::test_triangulation {
namespace {

using Eigen::Vector2d;

Outline polygon(const std::vector<Vector2d>& corners) {
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    outline.push_back({Curve::line({corners[i], corners[(i + 1) % corners.size()]})});
  }
  return outline;
}

Panel panelOf(std::vector<Outline> outlines) {
  Panel panel;
  panel.name = "panel";
  panel.fabric = "wool";
  panel.outlines = std::move(outlines);
  Pattern pattern;
  pattern.panels = {panel};
  requireSound(pattern, "made");
  return panel;
}

Panel mirrored(Panel panel) {
  for (Outline& outline : panel.outlines) {
    for (Edge& edge : outline) edge.curve = edge.curve.mirrored();
  }
  panel.warp.x() = -panel.warp.x();
  return panel;
}

// m^2, of the polygons that the particles along the edges make.
double outlinedArea(const PanelMesh& panel) {
  double area = 0.0;
  for (std::size_t k = 0; k < panel.edges.size(); ++k) {
    double part = 0.0;
    for (const EdgeParticles& edge : panel.edges[k]) {
      for (std::size_t i = 1; i < edge.particles.size(); ++i) {
        const auto& a = panel.mesh.rest_coordinates[edge.particles[i - 1]];
        const auto& b = panel.mesh.rest_coordinates[edge.particles[i]];
        part += 0.5 * (a.x() * b.y() - a.y() * b.x());
      }
    }
    area += k == 0 ? std::abs(part) : -std::abs(part);
  }
  return area;
}

// What is promised of every panel.
void expectSound(const PanelMesh& panel, double least_angle_of_all = 0.0) {
  requireSound(panel.mesh);
  const TriangleQuality quality = qualityOf(panel.mesh);
  EXPECT_EQ(quality.clockwise, 0);
  EXPECT_EQ(quality.not_delaunay, 0);
  EXPECT_NEAR(quality.area, outlinedArea(panel), 1e-12 * quality.area);
  EXPECT_GE(quality.least_angle, least_angle_of_all);
}

const double kWell = kLeastAngle * (1.0 - 1e-9);

TEST(Triangulation, CoversShippedGarmentsWithNearlyEqualTriangles) {
  for (const char* name : {"shirt", "pencil_dress"}) {
    const Pattern pattern =
        loadPattern(std::string(HAPTEX_CONFIG_DIRECTORY "/garments/") + name + ".yaml");
    for (const double edge_length : {0.03, 0.02, 0.01}) {
      for (const Panel& panel : pattern.panels) {
        SCOPED_TRACE(panel.name);
        const PanelMesh result = triangulate(panel, edge_length);
        expectSound(result, kWell);
        const TriangleQuality quality = qualityOf(result.mesh);
        EXPECT_NEAR(quality.mean, edge_length, 0.08 * edge_length);
        EXPECT_LT(quality.spread, 0.25 * edge_length);
        EXPECT_LT(quality.longest, 1.7 * edge_length);
        // Chords are shorter than curves: second order in the edge length.
        EXPECT_NEAR(quality.area, areaOf(panel), 2.0 * edge_length * edge_length * areaOf(panel));
      }
    }
  }
}

TEST(Triangulation, OutlinesAreFollowedToTheTolerance) {
  const Panel disc = panelOf({{{Curve::arc({0.1, 0.0}, {0.0, 0.1}, {-0.1, 0.0})},
                               {Curve::arc({-0.1, 0.0}, {0.0, -0.1}, {0.1, 0.0})}}});
  for (const double tolerance : {1e-3, 1e-5}) {
    const PanelMesh result = triangulate(disc, 0.03, tolerance);
    expectSound(result, kWell);
    for (const EdgeParticles& edge : result.edges[0]) {
      for (std::size_t i = 1; i < edge.particles.size(); ++i) {
        const Vector2d middle = 0.5 * (result.mesh.rest_coordinates[edge.particles[i - 1]] +
                                       result.mesh.rest_coordinates[edge.particles[i]]);
        EXPECT_LE(0.1 - middle.norm(), tolerance * (1.0 + 1e-9));
        // 0.03 m alone would make 0.00113 m.
        EXPECT_GE(0.1 - middle.norm(), 0.0);
      }
    }
  }
}

TEST(Triangulation, CornersWithinAnEdgeAreKept) {
  const Curve bent = Curve::line({{0.0, 0.0}, {0.0, -0.101}, {0.2, -0.101}, {0.2, 0.0}});
  const Panel panel = panelOf({{{bent}, {Curve::line({{0.2, 0.0}, {0.0, 0.0}})}}});
  const PanelMesh result = triangulate(panel, 0.02);
  expectSound(result, kWell);
  EXPECT_NEAR(qualityOf(result.mesh).area, 0.0202, 1e-15);
  // As few as the straight parts need: 6, 10 and 6.
  EXPECT_EQ(result.edges[0][0].particles.size(), 23u);
  EXPECT_NEAR(result.edges[0][0].lengths[6], 0.101, 1e-15);
  EXPECT_EQ(result.edges[0][0].lengths.back(), bent.length());
}

TEST(Triangulation, EdgesKnowTheirParticlesAndLengths) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  for (const Panel& panel : pattern.panels) {
    const PanelMesh result = triangulate(panel, 0.02);
    expectSound(result, kWell);
    ASSERT_EQ(result.edges.size(), panel.outlines.size());
    for (std::size_t k = 0; k < panel.outlines.size(); ++k) {
      for (std::size_t e = 0; e < panel.outlines[k].size(); ++e) {
        const Curve& curve = panel.outlines[k][e].curve;
        const EdgeParticles& edge = result.edges[k][e];
        EXPECT_EQ(edge.lengths.front(), 0.0);
        EXPECT_EQ(edge.lengths.back(), curve.length());
        const auto& next = result.edges[k][(e + 1) % panel.outlines[k].size()];
        EXPECT_EQ(edge.particles.back(), next.particles.front());
        for (std::size_t i = 0; i < edge.particles.size(); ++i) {
          if (i > 0) {
            EXPECT_GT(edge.lengths[i], edge.lengths[i - 1]);
            EXPECT_LE(edge.lengths[i] - edge.lengths[i - 1], 0.02 * (1.0 + 1e-9));
          }
          const Vector2d at = curve.at(curve.parameterAt(edge.lengths[i]));
          // Seen from the right side; particles that refinement added lie on the chord.
          const double u = isTurnedOver(panel) ? -at.x() : at.x();
          EXPECT_NEAR(
              (result.mesh.rest_coordinates[edge.particles[i]] - Vector2d(u, at.y())).norm(), 0.0,
              1e-3);
        }
      }
    }
  }
}

TEST(Triangulation, MirroredPanelsAreTheSameSeenFromTheRightSide) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  Panel panel = pattern.panels[0];
  panel.outlines.resize(1);  // points of arcs are not mirrored to the last bit
  const PanelMesh result = triangulate(panel, 0.02), other = triangulate(mirrored(panel), 0.02);
  EXPECT_EQ(other.mesh.rest_coordinates, result.mesh.rest_coordinates);
  EXPECT_EQ(other.mesh.triangles, result.mesh.triangles);
  // In the world they are turned over.
  const auto& pose = std::get<Eigen::Isometry3d>(panel.placement);
  const Eigen::Vector3d here = pose.inverse() * result.mesh.initial_positions[3];
  const Eigen::Vector3d there = pose.inverse() * other.mesh.initial_positions[3];
  EXPECT_NEAR(here.x(), -there.x(), 1e-15);
  EXPECT_NEAR(here.y(), there.y(), 1e-15);
}

TEST(Triangulation, RestCoordinatesLieAlongTheGrain) {
  Panel panel = panelOf({polygon({{0.0, 0.0}, {0.3, 0.0}, {0.3, 0.1}, {0.0, 0.1}})});
  panel.warp = Vector2d(1.0, 0.0);  // along the length
  const PanelMesh result = triangulate(panel, 0.02);
  double width = 0.0, height = 0.0;
  for (const Vector2d& rest : result.mesh.rest_coordinates) {
    width = std::max(width, std::abs(rest.x()));
    height = std::max(height, rest.y());
  }
  EXPECT_NEAR(width, 0.1, 1e-15);
  EXPECT_NEAR(height, 0.3, 1e-15);
  EXPECT_NEAR(qualityOf(result.mesh).area, 0.03, 1e-15);
}

TEST(Triangulation, HolesStayHoles) {
  const Panel panel = panelOf({polygon({{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.4}, {0.0, 0.4}}),
                               polygon({{0.1, 0.1}, {0.1, 0.2}, {0.2, 0.2}, {0.2, 0.1}}),
                               polygon({{0.3, 0.3}, {0.35, 0.3}, {0.3, 0.35}})});
  const PanelMesh result = triangulate(panel, 0.02);
  expectSound(result, kWell);
  EXPECT_NEAR(qualityOf(result.mesh).area, 0.16 - 0.01 - 0.00125, 1e-15);
}

TEST(Triangulation, SharpCornersKeepSmallAnglesToThemselves) {
  const double edge_length = 0.01;
  for (const double degrees : {3.0, 10.0, 25.0, 45.0, 59.0}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * M_PI / 180.0;
    const Panel wedge = panelOf(
        {polygon({{0.0, 0.0}, {0.3, 0.0}, {0.3 * std::cos(angle), 0.3 * std::sin(angle)}})});
    const PanelMesh result = triangulate(wedge, edge_length);
    expectSound(result);
    const auto& rest = result.mesh.rest_coordinates;
    const auto far = [&](const std::array<int, 3>& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [&](int particle) { return rest[particle].norm() > 4.0 * edge_length; });
    };
    EXPECT_GE(qualityOf(result.mesh, far).least_angle, kWell);
    EXPECT_GE(qualityOf(result.mesh).shortest, std::min(0.03, std::sin(angle)) * edge_length);
  }
}

TEST(Triangulation, NarrowPartsAreRefinedAsFarAsTheyAreNarrow) {
  // A strap of 2 mm between two squares, triangulated at 20 mm.
  const Panel panel = panelOf({polygon({{0.0, 0.0},
                                        {0.1, 0.0},
                                        {0.1, 0.049},
                                        {0.2, 0.049},
                                        {0.2, 0.0},
                                        {0.3, 0.0},
                                        {0.3, 0.1},
                                        {0.2, 0.1},
                                        {0.2, 0.051},
                                        {0.1, 0.051},
                                        {0.1, 0.1},
                                        {0.0, 0.1}})});
  const PanelMesh result = triangulate(panel, 0.02);
  expectSound(result, kWell);
  EXPECT_NEAR(qualityOf(result.mesh).area, 0.0202, 1e-15);
  EXPECT_GT(qualityOf(result.mesh).shortest, 0.0005);
  EXPECT_LT(result.mesh.triangles.size(), 1500u);
}

TEST(Triangulation, PointsOnCommonCirclesAndLinesAreNoTrouble) {
  // Many points of a regular grid: all circles hold four.
  std::vector<Vector2d> comb;
  for (int i = 0; i <= 10; ++i) {
    comb.emplace_back(0.02 * i, 0.0);
    if (i < 10) comb.emplace_back(0.02 * i + 0.01, -0.1);
  }
  comb.emplace_back(0.2, 0.1);
  comb.emplace_back(0.0, 0.1);
  const PanelMesh result = triangulate(panelOf({polygon(comb)}), 0.01);
  expectSound(result);
}

TEST(Triangulation, AGridOfWeftAndWarpIsCutAtTheOutline) {
  const double h = 0.02;
  Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  pattern.panels[0].warp = Vector2d(0.6, 0.8);  // at an angle to its sides
  for (const Panel& panel : pattern.panels) {
    SCOPED_TRACE(panel.name);
    const PanelMesh result = triangulate(panel, h, h / 20.0, Interior::kGrid);
    expectSound(result, kWell);
    std::set<int> on_outline;
    for (const auto& edges : result.edges) {
      for (const EdgeParticles& edge : edges) {
        on_outline.insert(edge.particles.begin(), edge.particles.end());
      }
    }
    const auto& rest = result.mesh.rest_coordinates;
    double of_grid = 0.0;
    for (const auto& triangle : result.mesh.triangles) {
      const auto far = [&](int particle) {
        return std::all_of(on_outline.begin(), on_outline.end(), [&](int other) {
          return (rest[particle] - rest[other]).norm() > 2.0 * h;
        });
      };
      if (!std::all_of(triangle.begin(), triangle.end(), far)) continue;
      // Half a square: its sides along weft and warp are h long.
      Vector2d low = rest[triangle[0]], high = low;
      for (const int particle : triangle) {
        low = low.cwiseMin(rest[particle]);
        high = high.cwiseMax(rest[particle]);
        EXPECT_NEAR(rest[particle].x() / h, std::round(rest[particle].x() / h), 1e-12);
        EXPECT_NEAR(rest[particle].y() / h, std::round(rest[particle].y() / h), 1e-12);
      }
      EXPECT_NEAR((high - low - Vector2d(h, h)).norm(), 0.0, 1e-14);
      of_grid += 0.5 * h * h;
    }
    EXPECT_GT(of_grid, 0.3 * areaOf(panel));
  }
}

TEST(Triangulation, IsTheSameEveryTime) {
  const Pattern pattern = parsePattern(kSmallGarment, "small.yaml");
  const PanelMesh first = triangulate(pattern.panels[0], 0.01);
  const PanelMesh second = triangulate(pattern.panels[0], 0.01);
  EXPECT_EQ(first.mesh.rest_coordinates, second.mesh.rest_coordinates);
  EXPECT_EQ(first.mesh.triangles, second.mesh.triangles);
}

// A star with a random radius at every angle, and a hole in its middle.
Panel randomStar(int seed) {
  base::RepeatableRandom random(seed);
  std::vector<Vector2d> corners, hole;
  const int count = 5 + seed % 20;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * (i + random.uniform(0.0, 0.6)) / count;
    corners.push_back(random.uniform(0.04, 0.3) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  for (int i = 0; i < 5; ++i) {
    const double angle = 2.0 * M_PI * i / 5.0 + 0.1 * seed;
    hole.push_back(random.uniform(0.002, 0.006) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return panelOf({polygon(corners), polygon(hole)});
}

TEST(Triangulation, OutlinesAtRandomAreCovered) {
  for (int seed = 0; seed < base::unlessSanitized(60, 12); ++seed) {
    SCOPED_TRACE(seed);
    const Panel panel = randomStar(seed);
    const PanelMesh result = triangulate(seed % 2 == 0 ? panel : mirrored(panel), 0.015);
    expectSound(result);
    EXPECT_NEAR(qualityOf(result.mesh).area, areaOf(panel), 1e-12 * areaOf(panel));
    // Angles are small only within reach of sharp corners.
    const auto& corners = panel.outlines[0];
    const auto far = [&](const std::array<int, 3>& triangle) {
      for (const int particle : triangle) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const Curve& in = corners[(i + corners.size() - 1) % corners.size()].curve;
          const Vector2d back = in.start() - in.end(), on = corners[i].curve.startDirection();
          if (back.normalized().dot(on) < 0.5) continue;  // at least 60 degrees
          const Vector2d at = corners[i].curve.start();
          if ((result.mesh.rest_coordinates[particle] - at).norm() < 0.06) return false;
        }
      }
      return true;
    };
    EXPECT_GE(qualityOf(result.mesh, far).least_angle, kWell);
  }
}

TEST(Triangulation, RefusesWhatItCannotDo) {
  const Panel panel = panelOf({polygon({{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}})});
  const auto refusal = [&](double edge_length, double tolerance) -> std::string {
    return test::refusalOf([&] { triangulate(panel, edge_length, tolerance); });
  };
  EXPECT_EQ(refusal(std::nan(""), 0.01),
            "triangulate: edge_length is nan; it must be >= 0.0005 m and <= 20 m");
  EXPECT_EQ(refusal(1e-4, 0.01),
            "triangulate: edge_length is 0.0001; it must be >= 0.0005 m and <= 20 m");
  EXPECT_EQ(refusal(0.01, 0.0), "triangulate: tolerance is 0; it must be finite and > 0");
  EXPECT_EQ(refusal(0.001, 0.01),
            "panel 'panel': edges of 0.001 m would make about 9237604.30703 triangles: allowed are "
            "2000000");
}

}  // namespace
}  // namespace haptex::garment::test_triangulation
