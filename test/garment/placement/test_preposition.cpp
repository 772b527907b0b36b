#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../../refusal.h"
#include "body/body_fixtures.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/garment/placement/preposition.h"

namespace haptex::garment::test_preposition {
namespace {

using Eigen::Vector3d;

// Two rectangles of 0.5 x 0.4 m around a column of 0.1 m radius, of which only the first says
// where it lies. The second is cut from the fabric turned over.
const std::string kTube = R"(source: made up for tests
carriers:
  - {name: tube, shape: cylinder, segment: spine}
panels:
  - name: front
    fabric: wool
    placement: {carrier: tube, angle: 0.2, along: 0.5}
    outline:
      - {line: [[0, 0], [0.5, 0]]}
      - {line: [[0.5, 0], [0.5, 0.4]]}
      - {line: [[0.5, 0.4], [0, 0.4]]}
      - {line: [[0, 0.4], [0, 0]]}
  - name: back
    fabric: wool
    placement: {carrier: tube}
    outline:
      - {line: [[0, 0], [0, 0.4]]}
      - {line: [[0, 0.4], [0.5, 0.4]]}
      - {line: [[0.5, 0.4], [0.5, 0]]}
      - {line: [[0.5, 0], [0, 0]]}
seams:
  - sides: [{panel: front, edges: [1]}, {panel: back, edges: [2], reversed: true}]
  - sides: [{panel: front, edges: [3]}, {panel: back, edges: [0], reversed: true}]
)";

std::string replaced(std::string text, const std::string& part, const std::string& other) {
  text.replace(text.find(part), part.size(), other);
  return text;
}

std::vector<PanelMesh> meshesOf(const Pattern& pattern, double edge_length) {
  std::vector<PanelMesh> meshes;
  for (const Panel& panel : pattern.panels) meshes.push_back(triangulate(panel, edge_length));
  return meshes;
}

double longestEdge(const mesh::ClothMesh& mesh) {
  double longest = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, (mesh.rest_coordinates[triangle[i]] -
                                   mesh.rest_coordinates[triangle[(i + 1) % 3]])
                                      .norm());
    }
  }
  return longest;
}

TEST(Preposition, SeamsLieBesideEachOther) {
  const Pattern pattern = parsePattern(kTube, "tube.yaml");
  std::vector<PanelMesh> meshes = meshesOf(pattern, 0.05);
  const Preposition laid = preposition(pattern, makePrism(0.1, 1.0, 24), meshes);
  ASSERT_EQ(laid.panels.size(), 2u);
  EXPECT_TRUE(laid.overlaps.empty());
  EXPECT_EQ(laid.panels[0].angle, 0.2);
  EXPECT_EQ(laid.panels[0].along, 0.5);
  EXPECT_NEAR(std::abs(std::remainder(laid.panels[1].angle - 0.2, 2 * M_PI)), M_PI, 1e-6);
  EXPECT_NEAR(laid.panels[1].along, 0.5, 1e-6);
  // Wide enough for both, with gaps of some millimetres.
  EXPECT_GT(laid.panels[0].surface.radius, 1.0 / (2 * M_PI));
  EXPECT_LT(laid.panels[0].surface.radius, 1.02 / (2 * M_PI));
  for (const LaidPanel& panel : laid.panels) {
    const double longest = longestEdge(meshes[panel.panel].mesh), radius = panel.surface.radius;
    EXPECT_LE(panel.surface_change, 1e-11);
    // Chords of arcs: shorter by l^2 / 24 r^2, and l^2 / 8 r inside.
    EXPECT_GT(panel.straight_change, 0.0);
    EXPECT_LE(panel.straight_change, longest * longest / (24 * radius * radius));
    EXPECT_GT(panel.sagitta, 0.0);
    EXPECT_LE(panel.sagitta, longest * longest / (8 * radius));
  }
}

TEST(Preposition, RightSidesLookOutwards) {
  const Pattern pattern = parsePattern(kTube, "tube.yaml");
  std::vector<PanelMesh> meshes = meshesOf(pattern, 0.05);
  const auto flat = meshes;
  preposition(pattern, makePrism(0.1, 1.0, 24), meshes);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const mesh::ClothMesh& mesh = meshes[i].mesh;
    EXPECT_EQ(mesh.rest_coordinates, flat[i].mesh.rest_coordinates);
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vector3d& corner = mesh.initial_positions[a];
      const Vector3d normal =
          (mesh.initial_positions[b] - corner).cross(mesh.initial_positions[c] - corner);
      EXPECT_GT(normal.dot(Vector3d(corner.x(), corner.y(), 0)), 0.0);
    }
  }
}

TEST(Preposition, LayersLieAroundEachOtherInTheirOrder) {
  for (const bool front_outside : {false, true}) {
    const std::string text =
        replaced(replaced(kTube, "{carrier: tube}", "{carrier: tube, angle: 0, along: 0.6}"),
                 front_outside ? "name: front\n" : "name: back\n",
                 front_outside ? "name: front\n    layer: 1\n" : "name: back\n    layer: 1\n");
    const Pattern pattern = parsePattern(text, "tube.yaml");
    std::vector<PanelMesh> meshes = meshesOf(pattern, 0.025);
    const Preposition laid = preposition(pattern, makePrism(0.1, 1.0, 24), meshes);
    EXPECT_TRUE(laid.overlaps.empty());
    const double front = laid.panels[0].surface.radius, back = laid.panels[1].surface.radius;
    EXPECT_NEAR(front_outside ? front - back : back - front, kLayerGap, 1e-12);
  }
}

/// The lining's sleeves are sewn to those of the shell at the cuffs.
TEST(Preposition, LayersOfASleeveAreShiftedTogether) {
  const Pattern pattern = loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/jacket.yaml");
  const Body body = loadBody(HAPTEX_CONFIG_DIRECTORY "/bodies/figure.yaml");
  std::vector<PanelMesh> meshes = meshesOf(pattern, 0.03);
  const Preposition laid = preposition(pattern, body, meshes);
  EXPECT_TRUE(laid.overlaps.empty());
  int compared = 0;
  for (const LaidPanel& shell : laid.panels) {
    for (const LaidPanel& lining : laid.panels) {
      const std::string& name = pattern.panels[shell.panel].name;
      if (pattern.panels[lining.panel].name != "lining_" + name) continue;
      EXPECT_NEAR(lining.along, shell.along, 0.01) << name;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 7);
}

TEST(Preposition, OverlapsAreReported) {
  const std::string text =
      replaced(kTube, "{carrier: tube}", "{carrier: tube, angle: 0.2, along: 0.55}");
  const Pattern pattern = parsePattern(text, "tube.yaml");
  std::vector<PanelMesh> meshes = meshesOf(pattern, 0.05);
  const Preposition laid = preposition(pattern, makePrism(0.1, 1.0, 24), meshes);
  ASSERT_EQ(laid.overlaps.size(), 1u);
  EXPECT_EQ(laid.overlaps[0].first, "front");
  EXPECT_EQ(laid.overlaps[0].second, "back");
  EXPECT_GT(laid.overlaps[0].pairs, 100);
}

TEST(Preposition, WhatIsNotKnownIsRefused) {
  const Body body = makePrism(0.1, 1.0, 24);
  const auto refusal = [&](const std::string& text) -> std::string {
    const Pattern pattern = parsePattern(text, "tube.yaml");
    std::vector<PanelMesh> meshes = meshesOf(pattern, 0.1);
    return test::refusalOf([&] { preposition(pattern, body, meshes); });
  };
  EXPECT_EQ(refusal(replaced(kTube, "segment: spine", "segment: tail")),
            "carrier 'tube': segment 'tail' is unknown: the body has spine");
  EXPECT_EQ(refusal(replaced(kTube, ", angle: 0.2, along: 0.5", ", angle: 0.2")),
            "panel 'front': where it lies is not known: it, or one that it is sewn to, must have a "
            "position, or an angle and how far it lies along its carrier");
  std::vector<PanelMesh> none;
  EXPECT_THROW(preposition(parsePattern(kTube, "tube.yaml"), body, none), std::invalid_argument);
}

TEST(Preposition, PlacementsOnCarriersAreWrittenAndReadAgain) {
  const std::string text =
      replaced(kTube, "{carrier: tube}", "{carrier: tube, along: -0.25, turn: 0.5}");
  const Pattern pattern = parsePattern(text, "tube.yaml");
  const Pattern again = parsePattern(writePattern(pattern), "again.yaml");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& before = std::get<OnCarrier>(pattern.panels[i].placement);
    const auto& after = std::get<OnCarrier>(again.panels[i].placement);
    EXPECT_EQ(before.angle, after.angle);
    EXPECT_EQ(before.along, after.along);
    EXPECT_EQ(before.turn, after.turn);
  }
  EXPECT_FALSE(std::get<OnCarrier>(again.panels[1].placement).angle);
}

TEST(Preposition, ShippedGarmentsLieAroundBothBodiesWithoutIntersections) {
  for (const char* garment : {"fitted_shirt", "fitted_dress"}) {
    const Pattern pattern =
        loadPattern(std::string(HAPTEX_CONFIG_DIRECTORY "/garments/") + garment + ".yaml");
    for (const char* name : {"woman.yaml", "man.yaml"}) {
      std::vector<PanelMesh> meshes = meshesOf(pattern, 0.02);
      const Preposition laid = preposition(pattern, loadBody(bodyPath(name)), meshes);
      for (const Overlap& overlap : laid.overlaps) {
        ADD_FAILURE() << garment << " on " << name << ": " << overlap.first << " and "
                      << overlap.second;
      }
      ASSERT_EQ(laid.panels.size(), pattern.panels.size());
      for (const LaidPanel& panel : laid.panels) EXPECT_LE(panel.surface_change, 1e-9);
    }
  }
}

}  // namespace
}  // namespace haptex::garment::test_preposition
