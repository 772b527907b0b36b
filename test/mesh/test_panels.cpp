#include <gtest/gtest.h>

#include <cmath>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh::test_panels {
namespace {

using Eigen::Vector2d;

/// Two squares of two triangles, sewn along particles 1 and 2; the right one has axes of its own.
ClothMesh twoPanels() {
  ClothMesh mesh;
  mesh.rest_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {2, 1}};
  for (const Vector2d& rest : mesh.rest_coordinates) {
    mesh.initial_positions.emplace_back(0.0, rest.x(), rest.y());
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  mesh.panels = {{0, 0.0}, {1, 0.5 * M_PI}};
  mesh.triangle_panels = {0, 0, 1, 1};
  mesh.corner_coordinates = {{Vector2d(0, 0), Vector2d(1, 0), Vector2d(1, 1)},
                             {Vector2d(0, 0), Vector2d(1, 1), Vector2d(0, 1)},
                             {Vector2d(5, 0), Vector2d(6, 0), Vector2d(6, 1)},
                             {Vector2d(5, 0), Vector2d(6, 1), Vector2d(5, 1)}};
  return mesh;
}

TEST(Panels, ASheetIsOneOfTheFirstFabricAlongTheGrain) {
  const ClothMesh sheet = makeRectangle(0.2, 0.1, 2, 1, Triangulation::kOneWay);
  EXPECT_EQ(sheet.panelCount(), 1);
  EXPECT_EQ(sheet.panel(sheet.panelOf(3)).fabric, 0);
  EXPECT_EQ(sheet.restCorners(1)[0], sheet.rest_coordinates[sheet.triangles[1][0]]);
  const CutPanel cut = cutPanel(sheet, 0);
  EXPECT_EQ(cut.sheet.triangles, sheet.triangles);
  EXPECT_EQ(cut.sheet.rest_coordinates, sheet.rest_coordinates);
  EXPECT_EQ(cut.sheet.initial_positions, sheet.initial_positions);
}

TEST(Panels, AParticleOfASeamHasARestCoordinateInEach) {
  const ClothMesh mesh = twoPanels();
  EXPECT_TRUE(findDefects(mesh).none()) << findDefects(mesh).description();
  EXPECT_EQ(mesh.restCorners(0)[1], Vector2d(1, 0));
  // Weft of the right panel's fabric lies along its v axis.
  EXPECT_LT((mesh.restCorners(2)[0] - Vector2d(0, -5)).norm(), 1e-15);
  EXPECT_LT((mesh.restCorners(2)[2] - Vector2d(1, -6)).norm(), 1e-15);
  EXPECT_EQ(mesh.panel(mesh.panelOf(3)).fabric, 1);
}

TEST(Panels, CutOneIsASheetOfItsOwnParticles) {
  const CutPanel cut = cutPanel(twoPanels(), 1);
  EXPECT_EQ(cut.particles, (std::vector<int>{1, 2, 4, 5}));
  EXPECT_EQ(twoPanels().panel(1).fabric, 1);
  ASSERT_EQ(cut.sheet.triangles.size(), 2u);
  EXPECT_EQ(cut.sheet.triangles[1], (std::array<int, 3>{0, 3, 1}));
  EXPECT_TRUE(findDefects(cut.sheet).none());
  EXPECT_LT((cut.sheet.rest_coordinates[1] - Vector2d(1, -5)).norm(), 1e-15);
}

TEST(Panels, DefectsAreNamed) {
  ClothMesh mesh = twoPanels();
  mesh.triangle_panels[2] = 2;
  EXPECT_EQ(findDefects(mesh).description(), "triangles of a panel that does not exist: 2");
  mesh = twoPanels();
  mesh.triangle_panels.pop_back();
  EXPECT_EQ(findDefects(mesh).description(),
            "panels, corner coordinates or fabrics are not as many as triangles");
  mesh = twoPanels();
  mesh.panels[0].grain = std::nan("");
  EXPECT_EQ(mesh.panels.size(), 2u);
  EXPECT_NE(findDefects(mesh).description().find(
                "panels of a fabric below 0 or with a grain that is not finite: 0"),
            std::string::npos);
  mesh = twoPanels();
  mesh.corner_coordinates[3] = {Vector2d(5, 0), Vector2d(6, 0), Vector2d(7, 0)};
  EXPECT_EQ(findDefects(mesh).description(), "degenerate triangles: 3");
}

}  // namespace
}  // namespace haptex::mesh::test_panels
