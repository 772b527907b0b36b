// Garments as meshes: seams whose sides meet particle by particle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/garment/body/body_file.h"
#include "haptex/garment/garment_mesh.h"
#include "haptex/garment/pattern/pattern_file.h"

namespace haptex::garment::test_garment_mesh {
namespace {

Pattern shipped(const std::string& name) {
  return loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/" + name + ".yaml");
}

/// Two panels, the second side of their seam of three edges, one of them longer by its easing.
constexpr const char* kCorners = R"(
source: drawn for a test
panels:
  - name: left
    fabric: wool
    outline:
      - {line: [[0, 0], [0.3, 0]]}
      - {quadratic: [[0.3, 0], [0.35, 0.2], [0.3, 0.4]], name: seam}
      - {line: [[0.3, 0.4], [0, 0.4], [0, 0]]}
  - name: right
    fabric: denim
    outline:
      - {line: [[0.4, 0], [0.7, 0], [0.7, 0.4], [0.4, 0.4]]}
      - {line: [[0.4, 0.4], [0.4, 0.31]]}
      - {line: [[0.4, 0.31], [0.41, 0.13]]}
      - {line: [[0.41, 0.13], [0.4, 0]]}
seams:
  - sides: [{panel: left, edges: [seam]}, {panel: right, edges: [1, 3], reversed: true}]
    easing: 0.1
)";

/// A square and its lining, which is sewn to it along two sides that meet, and along a third.
constexpr const char* kLined = R"(
source: drawn for a test
panels:
  - name: shell
    fabric: wool
    layer: 1
    outline: &square
      - {line: [[0, 0], [0.3, 0]], name: hem}
      - {line: [[0.3, 0], [0.3, 0.3]], name: opening}
      - {line: [[0.3, 0.3], [0, 0.3]], name: neck}
      - {line: [[0, 0.3], [0, 0]]}
  - name: lining
    fabric: wool
    outline: *square
seams:
  - sides: [{panel: shell, edges: [hem]}, {panel: lining, edges: [hem]}]
  - sides: [{panel: shell, edges: [opening]}, {panel: lining, edges: [opening]}]
  - sides: [{panel: shell, edges: [neck]}, {panel: lining, edges: [neck]}]
)";

/// Edges that more than two triangles have.
std::size_t edgesOfSeveral(const mesh::ClothMesh& mesh) {
  std::map<std::array<int, 2>, int> triangles;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      ++triangles[{a, b}];
    }
  }
  return static_cast<std::size_t>(std::count_if(triangles.begin(), triangles.end(),
                                                [](const auto& edge) { return edge.second > 2; }));
}

double areaOf(const mesh::ClothMesh& mesh, int panel) {
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panelOf(t) != panel) continue;
    const auto [a, b, c] = mesh.restCorners(t);
    const Eigen::Vector2d ab = b - a, ac = c - a;
    area += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  return area;
}

std::size_t withoutPartner(const std::vector<double>& places, const std::vector<double>& others) {
  return static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [&](double place) {
    return std::none_of(others.begin(), others.end(),
                        [&](double other) { return std::abs(place - other) < 1e-12; });
  }));
}

TEST(GarmentMesh, DividesBothSidesOfEverySeamAlike) {
  for (const char* name : {"shirt", "pencil_dress"}) {
    for (const double edge_length : {0.04, 0.03, 0.02}) {
      const Pattern pattern = shipped(name);
      const GarmentMesh garment = makeGarmentMesh(pattern, edge_length);
      ASSERT_EQ(garment.seams.size(), pattern.seams.size());
      std::size_t particles = 0, alone = 0;
      for (const mesh::Seam& seam : garment.seams) {
        particles += seam.first.size();
        alone += withoutPartner(seam.first_places, seam.second_places) +
                 withoutPartner(seam.second_places, seam.first_places);
      }
      EXPECT_EQ(alone, 0u) << name << ", of " << particles;
    }
  }
}

TEST(GarmentMesh, SewnHasOneParticleWhereItsSidesHadTwo) {
  const Pattern pattern = parsePattern(kCorners, "corners");
  const GarmentMesh garment = makeGarmentMesh(pattern, 0.02);
  const mesh::Seam& seam = garment.seams.front();
  const mesh::MergedMesh merged = mesh::merge(garment.mesh, garment.seams);
  EXPECT_EQ(merged.mesh.triangles.size(), garment.mesh.triangles.size());
  EXPECT_EQ(merged.mesh.rest_coordinates.size() + seam.first.size(),
            garment.mesh.rest_coordinates.size());
}

TEST(GarmentMesh, HasAParticleWhereTheOtherSideHasACorner) {
  const GarmentMesh garment = makeGarmentMesh(parsePattern(kCorners, "corners"), 0.02);
  const mesh::Seam& seam = garment.seams.front();
  ASSERT_EQ(seam.first.size(), seam.second.size());
  const double middle = std::hypot(0.01, 0.18), top = 0.09, bottom = std::hypot(0.01, 0.13);
  const double length = top + middle + bottom;
  for (const double place : {bottom / length, (bottom + middle) / length}) {
    double nearest = 1.0;
    for (const double at : seam.first_places) nearest = std::min(nearest, std::abs(at - place));
    EXPECT_LT(nearest, 1e-12);
  }
}

/// Both have a triangle in the corners between the seams, of the same three particles.
TEST(GarmentMesh, HasNoEdgeOfFourTrianglesWhereALiningIsSewnToItsShellAroundACorner) {
  for (const double edge_length : {0.1, 0.05, 0.03}) {
    const GarmentMesh garment = makeGarmentMesh(parsePattern(kLined, "lined"), edge_length);
    for (const GarmentMesh& fine : {garment, halved(garment)}) {
      const mesh::ClothMesh sewn = mesh::merge(fine.mesh, fine.seams).mesh;
      EXPECT_NO_THROW(mesh::requireSound(sewn));
      EXPECT_EQ(edgesOfSeveral(sewn), 0u) << edge_length;
      EXPECT_NEAR(areaOf(sewn, 0), 0.09, 1e-12);
      EXPECT_NEAR(areaOf(sewn, 1), 0.09, 1e-12);
    }
  }
}

TEST(GarmentMesh, IsOfThePanelsOfThePattern) {
  const Pattern pattern = parsePattern(kCorners, "corners");
  const GarmentMesh garment = makeGarmentMesh(pattern, 0.02);
  EXPECT_EQ(garment.panel_names, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(garment.fabrics, (std::vector<std::string>{"wool", "denim"}));
  EXPECT_NO_THROW(mesh::requireSound(garment.mesh));
  EXPECT_EQ(garment.mesh.fabricOf(garment.mesh.triangles.size() - 1), 1);
  // Of straight lines exact, of the curve within a twentieth of an edge along its length.
  EXPECT_NEAR(areaOf(garment.mesh, 1), garment::areaOf(pattern.panels[1]), 1e-12);
  EXPECT_NEAR(areaOf(garment.mesh, 0), garment::areaOf(pattern.panels[0]), 0.4 * 0.02 / 20.0);
}

TEST(GarmentMesh, RefusesPanelsThatAreStillToBeLaidOnACarrier) {
  Pattern pattern = parsePattern(kCorners, "corners");
  pattern.panels[1].placement = OnCarrier{"torso", 0.0, 0.5};
  try {
    makeGarmentMesh(pattern, 0.02);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("panel 'right'"), std::string::npos)
        << refusal.what();
  }
}

/// Straight edges cut the curve of a cylinder short, by l^2 / 24 r^2 of their length at most; r is
/// above 50 mm for all that fits around an arm with a margin.
TEST(GarmentMesh, IsBentAroundABodyByItsCarriersAndNotStretched) {
  constexpr double kEdge = 0.03, kRadius = 0.05;  // m
  const Body body = loadBody(HAPTEX_CONFIG_DIRECTORY "/bodies/woman.yaml");
  const GarmentMesh garment = makeGarmentMesh(shipped("fitted_shirt"), kEdge, body);
  EXPECT_NO_THROW(mesh::requireSound(garment.mesh));
  const auto& rest = garment.mesh.rest_coordinates;
  const auto& at = garment.mesh.initial_positions;
  bool is_bent = false;
  for (const auto& triangle : garment.mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      const double length = (rest[b] - rest[a]).norm();
      const double change = (at[b] - at[a]).norm() / length - 1.0;
      EXPECT_LT(change, 1e-9);
      EXPECT_GT(change, -length * length / (24.0 * kRadius * kRadius));
      is_bent = is_bent || change < -1e-4;
    }
  }
  EXPECT_TRUE(is_bent);
}

}  // namespace
}  // namespace haptex::garment::test_garment_mesh
