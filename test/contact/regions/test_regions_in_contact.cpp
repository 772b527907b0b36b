// Fabric under the finger, where the cloth is of several.
#include <gtest/gtest.h>

#include <cmath>

#include "../fixtures.h"
#include "haptex/contact/obstacles/obstacle_collision.h"

namespace haptex::contact::test_regions_in_contact {
namespace {

using base::Finger;
using Eigen::Vector3d;

material::Fabric denim() {
  return material::loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/denim.yaml");
}

/// The small sample, of fabric 1 where u > 20 mm (weft along y: y > 0).
mesh::ClothMesh dividedSample() {
  mesh::ClothMesh mesh = smallSample();
  for (const auto& [a, b, c] : mesh.triangles) {
    const double u =
        mesh.rest_coordinates[a].x() + mesh.rest_coordinates[b].x() + mesh.rest_coordinates[c].x();
    mesh.triangle_fabrics.push_back(u > 3.0 * 0.02 ? 1 : 0);
  }
  return mesh;
}

std::vector<int> all(const mesh::ClothMesh& mesh) {
  std::vector<int> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) triangles.push_back(static_cast<int>(t));
  return triangles;
}

/// Force on a finger that presses at y, in the first step: all is in its plane still.
FingertipContact pressedAt(HapticLayer& layer, double y, HapticSettings::Layer kind) {
  const mesh::ClothMesh mesh = dividedSample();
  if (kind == HapticSettings::Layer::kPatch) {
    layer.exchange(layer.preparePatch(all(mesh), nothingAttached(mesh)));
  }
  layer.receive(mesh.initial_positions, atRest(mesh), 0.02);
  layer.step(
      {pressing(layer.law(), kSmallSampleMiddle + Vector3d(0.0, y, 0.0), 5e-4), std::nullopt});
  return layer.contacts()[Finger::kIndex];
}

class TouchedRegions : public testing::TestWithParam<HapticSettings::Layer> {
 protected:
  TouchedRegions() { settings_.layer = GetParam(); }
  HapticSettings settings_;
};
INSTANTIATE_TEST_SUITE_P(Layers, TouchedRegions,
                         testing::Values(HapticSettings::Layer::kPatch,
                                         HapticSettings::Layer::kWholeCloth));

TEST_P(TouchedRegions, OfOneFabricFeelAsTheSheet) {
  HapticLayer sheet(smallSample(), wool(), {true, Vector3d::Zero()}, settings_);
  HapticLayer of_two(dividedSample(), {wool(), wool()}, {true, Vector3d::Zero()}, settings_);
  const FingertipContact whole = pressedAt(sheet, 0.001, GetParam());
  const FingertipContact parts = pressedAt(of_two, 0.001, GetParam());
  EXPECT_TRUE(whole.touching);
  EXPECT_LT((whole.force - parts.force).norm(), 1e-9 * whole.force.norm());
}

TEST_P(TouchedRegions, FeelAsTheirFabricAndSayWhichItIs) {
  HapticLayer of_two(dividedSample(), {wool(), denim()}, {true, Vector3d::Zero()}, settings_);
  EXPECT_EQ(of_two.law(1).friction(), *denim().friction);
  const FingertipContact left = pressedAt(of_two, -0.0125, GetParam());
  EXPECT_EQ(left.fabric, 0);
  HapticLayer again(dividedSample(), {wool(), denim()}, {true, Vector3d::Zero()}, settings_);
  const FingertipContact right = pressedAt(again, 0.0125, GetParam());
  EXPECT_EQ(right.fabric, 1);
  // As the whole sheet of that fabric does, under a finger at the same place.
  HapticLayer alone(dividedSample(), {wool(), wool()}, {true, Vector3d::Zero()}, settings_);
  EXPECT_NEAR(left.normal_force, pressedAt(alone, -0.0125, GetParam()).normal_force,
              0.01 * left.normal_force);
  EXPECT_GT(std::abs(right.normal_force - left.normal_force), 0.05 * left.normal_force);
}

TEST(TouchedRegion, OfAFabricThatIsNotThereIsRefused) {
  EXPECT_THROW(HapticLayer(dividedSample(), wool(), {}, {}), std::invalid_argument);
  material::Fabric limp = denim();
  limp.bending.reset();
  EXPECT_THROW(HapticLayer(dividedSample(), {wool(), limp}, {}, {}), std::invalid_argument);
}

TEST(TouchedRegion, HasPatchesWhoseParticlesKeepTheirFabricHoweverTheyAreCut) {
  const mesh::ClothMesh mesh = dividedSample();
  const MeshTopology topology(mesh);
  const RefinedCut whole = cutAndRefine(mesh, topology, all(mesh), nothingAttached(mesh), 2);
  std::vector<int> part;
  for (std::size_t t = mesh.triangles.size() / 3; t < mesh.triangles.size(); ++t) {
    part.push_back(static_cast<int>(t));
  }
  const RefinedCut cut = cutAndRefine(mesh, topology, part, nothingAttached(mesh), 2);
  ASSERT_EQ(cut.fabrics.size(), cut.supports.size());
  ASSERT_EQ(cut.mesh.triangle_fabrics.size(), cut.mesh.triangles.size());
  for (const int particle : cut.order) {
    const auto same =
        std::find(whole.supports.begin(), whole.supports.end(), cut.supports[particle]);
    ASSERT_NE(same, whole.supports.end());
    EXPECT_EQ(cut.fabrics[particle], whole.fabrics[same - whole.supports.begin()]);
    const double u = cut.mesh.rest_coordinates[particle].x();
    if (std::abs(u - 0.02) > 1e-9) {
      EXPECT_EQ(cut.fabrics[particle], u > 0.02 ? 1 : 0);
    }
  }
}

TEST(RegionsOnAPlate, SlideEachByItsFriction) {
  mesh::ClothMesh mesh = dividedSample();
  for (Vector3d& place : mesh.initial_positions) {
    place = {place.z(), place.y(), ObstacleCollision::kOffset};
  }
  material::Fabric slippery = wool(), rough = wool();
  slippery.friction = 0.0;
  rough.friction = 0.3;
  cloth::ModelledEffects effects;
  effects.contacts = true;
  effects.gravity = {0.0, 0.0, -9.81};
  cloth::Cloth cloth(mesh, {slippery, rough}, effects);
  const mesh::Obstacle plate{"plate", mesh::ObstacleBox{{1.0, 1.0, 0.02}},
                             Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.01))};
  ObstacleCollision collision(cloth, {plate});
  cloth::ClothState state = cloth.initialState();
  for (Vector3d& velocity : state.velocities) velocity = {0.0, 1.0, 0.0};
  cloth::Integrator integrator(cloth, {});
  double momentum = 0.0, friction = 0.0;
  const double h = 1e-3;
  ASSERT_TRUE(collision.step(cloth, integrator, state, h).accepted);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    momentum += cloth.masses()[i] * (1.0 - state.velocities[i].y());
    const double u = mesh.rest_coordinates[i].x();
    const double coefficient = std::abs(u - 0.02) < 1e-9 ? 0.15 : (u > 0.02 ? 0.3 : 0.0);
    friction += coefficient * cloth.masses()[i] * 9.81 * h;
  }
  EXPECT_NEAR(momentum, friction, 0.01 * friction);
}

}  // namespace
}  // namespace haptex::contact::test_regions_in_contact
