// Garments of two layers, and what holds a garment closed.
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "dressing_fixtures.h"
#include "haptex/base/workload.h"
#include "haptex/dressing/drape.h"
#include "haptex/dressing/fastened.h"

namespace haptex::dressing::test_lined {
namespace {

constexpr double kEdge = base::unlessSanitized(0.05, 0.1);  // m

/// A tube and its lining, 10 mm within it and sewn to it along both hems of the front.
garment::Pattern linedTube() {
  garment::Pattern pattern = tube(0.15);
  for (int p : {0, 1}) {
    garment::Panel lining = pattern.panels[p];
    lining.name = "lining of " + lining.name;
    pattern.panels[p].layer = 1;
    std::get<Eigen::Isometry3d>(lining.placement).translation().x() += p == 0 ? -0.01 : 0.01;
    pattern.panels.push_back(lining);
  }
  for (int s : {0, 1}) {
    garment::Seam seam = pattern.seams[s];
    for (garment::SeamSide& side : seam.sides) side.panel += 2;
    pattern.seams.push_back(seam);
  }
  for (int p : {0, 1}) {
    for (int hem : {0, 2}) {
      garment::Seam seam;
      seam.sides[0] = {p, 0, hem, hem, false};
      seam.sides[1] = {p + 2, 0, hem, hem, false};
      pattern.seams.push_back(seam);
    }
  }
  return pattern;
}

/// It comes to rest with a filament cloth as stiff as linings are, at 12 to 16 kN/m.
TEST(Lined, ComesToRestWithItsLiningWithinIt) {
  garment::Pattern pattern = linedTube();
  for (int p : {2, 3}) pattern.panels[p].fabric = "polyester_satin";
  std::vector<material::Fabric> fabrics = wool();
  fabrics.push_back(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/polyester_satin.yaml"));
  const DrapeOutcome outcome =
      drape(garment::makeGarmentMesh(pattern, kEdge), fabrics, cone(0.2, 0.04, 0.4), {});
  EXPECT_TRUE(outcome.isSound());
  EXPECT_EQ(outcome.intersecting_states, 0);
  EXPECT_LE(outcome.fastest, DrapeSettings().rest_speed);
}

TEST(Fastened, PlacesAreWhereThePanelsHaveThem) {
  garment::Pattern pattern = tube(0.15);
  pattern.fastenings = {{"button", {{{0, {0.1, 0.05}}, {1, {-0.02, 0.17}}}}}};
  const garment::GarmentMesh garment = garment::makeGarmentMesh(pattern, kEdge);
  const std::vector<cloth::Fastener> fasteners = fastened(pattern, garment.mesh, 100.0);
  ASSERT_EQ(fasteners.size(), 1u);
  EXPECT_EQ(fasteners[0].stiffness, 100.0);
  for (int i : {0, 1}) {
    const cloth::ClothPlace& place = fasteners[0].places[i];
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      at += place.weights[k] * garment.mesh.initial_positions[place.particles[k]];
    }
    const garment::PlaceOnPanel& expected = pattern.fastenings[0].places[i];
    const auto& pose = std::get<Eigen::Isometry3d>(pattern.panels[i].placement);
    EXPECT_LT((at - pose * Eigen::Vector3d(expected.at.x(), expected.at.y(), 0.0)).norm(), 1e-12);
  }
}

TEST(Fastened, RefusesAPlaceThatTheTrianglesLeaveOut) {
  garment::Pattern pattern = tube(0.15);
  pattern.fastenings = {{"button", {{{0, {0.1, 0.05}}, {1, {-0.2, 0.1}}}}}};
  const garment::GarmentMesh garment = garment::makeGarmentMesh(pattern, kEdge);
  const std::string refusal = test::refusalOf([&] { fastened(pattern, garment.mesh, 100.0); });
  EXPECT_NE(refusal.find("(-0.2, 0.1) is in no triangle of panel 'back'"), std::string::npos)
      << refusal;
}

/// The tube is sewn along one side only, and fastened along the other.
TEST(Fastened, StaysTogetherWhileAGarmentComesToRest) {
  garment::Pattern pattern = tube(0.15);
  pattern.seams.pop_back();
  for (const double y : {0.04, 0.16}) {
    pattern.fastenings.push_back(
        {"button at " + std::to_string(y), {{{0, {-0.14, y}}, {1, {-0.14, y}}}}});
  }
  const DrapeOutcome outcome =
      drape(garment::makeGarmentMesh(pattern, kEdge), wool(), cone(0.2, 0.04, 0.4), {});
  EXPECT_TRUE(outcome.isSound());
  for (const cloth::Fastener& fastener : fastened(pattern, outcome.mesh, 1.0)) {
    std::array<Eigen::Vector3d, 2> ends = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int i : {0, 1}) {
      for (int k = 0; k < 3; ++k) {
        const cloth::ClothPlace& place = fastener.places[i];
        ends[i] += place.weights[k] * outcome.mesh.initial_positions[place.particles[k]];
      }
    }
    EXPECT_LT((ends[1] - ends[0]).norm(), 0.01) << fastener.name;
  }
}

}  // namespace
}  // namespace haptex::dressing::test_lined
