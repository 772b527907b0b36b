#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "../refusal.h"
#include "fixtures.h"

namespace haptex::contact::test_haptic_layer {
namespace {

using test::refusalOf;

using base::Finger;
using Eigen::Vector3d;

class HapticLayerTest : public testing::Test {
 protected:
  HapticLayerTest() { layer_.exchange(layer_.preparePatch(middle_, nothingAttached(mesh_))); }

  void receiveRest() { layer_.receive(mesh_.initial_positions, atRest(mesh_), 0.02); }
  void step(const Fingertips& fingertips, int steps = 1) {
    for (int i = 0; i < steps; ++i) layer_.step(fingertips);
  }
  Fingertip pressingMiddle(double depth = 1e-3) const {
    return pressing(layer_.law(), kSmallSampleMiddle, depth);
  }
  const mesh::ClothMesh mesh_ = smallSample();
  const std::vector<int> middle_ = trianglesAround(mesh_, {0.02, 0.02}, 0.01);
  HapticLayer layer_{mesh_, wool(), {true, Vector3d::Zero()}, {}};
};

TEST_F(HapticLayerTest, HasNoContactBeforeTheFirstState) {
  step({pressingMiddle(), std::nullopt}, 5);
  EXPECT_FALSE(layer_.contacts()[Finger::kIndex].touching);
  EXPECT_TRUE(layer_.loads().empty());
  receiveRest();
  step({pressingMiddle(), std::nullopt}, 2);
  EXPECT_TRUE(layer_.contacts()[Finger::kIndex].touching);
}

TEST_F(HapticLayerTest, IsPinchedByFingertipsThatPressFromOppositeSides) {
  receiveRest();
  const Fingertip index = pressingMiddle();
  Fingertip thumb = index;
  step({index, std::nullopt}, 2);
  EXPECT_FALSE(layer_.isPinched());
  thumb.position.y() += 5e-3;
  step({index, thumb}, 2);
  EXPECT_FALSE(layer_.isPinched()) << "both from one side";
  thumb.position = {-index.position.x(), 0.0, index.position.z()};
  step({index, std::nullopt}, 1);
  step({index, thumb}, 2);
  EXPECT_TRUE(layer_.isPinched());
  step({index, std::nullopt}, 1);
  EXPECT_FALSE(layer_.isPinched());
}

TEST_F(HapticLayerTest, NothingHoldsAFingertipBeforeTheFirstState) {
  HapticSettings settings;
  settings.layer = HapticSettings::Layer::kWholeCloth;
  HapticLayer whole(mesh_, wool(), {true, Vector3d::Zero()}, settings);
  for (const double x : {0.02, 0.01, 0.0, -0.01}) {  // through the origin
    Fingertip tip = pressingMiddle();
    tip.position = {x, 0.0, 0.0};
    whole.step({tip, std::nullopt});
    EXPECT_EQ(whole.held(Finger::kIndex)->position, tip.position);
  }
}

TEST_F(HapticLayerTest, WhatTheFingertipFeelsIsWhatItsPointsCarry) {
  receiveRest();
  step({pressingMiddle(), std::nullopt}, 300);
  const FingertipContact& felt = layer_.contacts()[Finger::kIndex];
  ASSERT_TRUE(felt.touching);
  Vector3d force = Vector3d::Zero(), loads = Vector3d::Zero();
  double normal = 0.0;
  for (const ContactPoint& point : felt.points) {
    force -= point.normal_force * point.normal + point.tangential_force;
    normal += point.normal_force;
  }
  for (const cloth::PointLoad& load : layer_.loads()) loads += load.force;
  EXPECT_NEAR((force - felt.force).norm(), 0.0, 1e-12);
  EXPECT_NEAR((loads + felt.force).norm(), 0.0, 1e-12) << "not what acts on the cloth";
  EXPECT_NEAR(normal, felt.normal_force, 1e-12);
  EXPECT_GT(felt.force.x(), 0.01);
  EXPECT_NEAR(felt.normal.x(), -1.0, 1e-3);
  EXPECT_NEAR((felt.fabric_position - Eigen::Vector2d(0.02, 0.02)).norm(), 0.0, 1e-4);
  EXPECT_FALSE(layer_.contacts()[Finger::kThumb].touching);
}

TEST_F(HapticLayerTest, TellsHowTheFingertipSlidesOverTheFabricInItsOwnDirections) {
  receiveRest();
  Fingertip fingertip = pressingMiddle();
  step({fingertip, std::nullopt}, 300);
  fingertip.velocity = {0.0, 0.03, -0.04};  // weft along +y, warp along +z
  step({fingertip, std::nullopt});
  const FingertipContact& felt = layer_.contacts()[Finger::kIndex];
  // The cloth moves a little too within the step.
  EXPECT_NEAR((felt.fabric_velocity - Eigen::Vector2d(0.03, -0.04)).norm(), 0.0, 0.005);
  EXPECT_NEAR((felt.to_fabric * Vector3d(1.0, 2.0, 3.0) - Eigen::Vector2d(2.0, 3.0)).norm(), 0.0,
              0.1)
      << "the cloth is dented and a little stretched";
}

TEST_F(HapticLayerTest, ItsLoadsAreWhatTheClothAccepts) {
  receiveRest();
  step({pressingMiddle(), std::nullopt}, 50);
  ASSERT_FALSE(layer_.loads().empty());
  cloth::ModelledEffects effects;
  effects.point_loads = true;
  cloth::Cloth cloth(mesh_, wool(), effects);
  EXPECT_NO_THROW(cloth.setPointLoads(layer_.loads()));
}

TEST_F(HapticLayerTest, WithoutAFingertipNearThereIsNoPatchAndNothingToStep) {
  receiveRest();
  step({pressingMiddle(), std::nullopt}, 50);
  EXPECT_GT(layer_.particleCount(), 0u);
  std::unique_ptr<Patch> none = layer_.preparePatch({}, nothingAttached(mesh_));
  EXPECT_EQ(none, nullptr);
  const std::unique_ptr<Patch> left = layer_.exchange(std::move(none));
  const std::vector<Vector3d> places = left->positions();
  EXPECT_EQ(layer_.patch(), nullptr);
  EXPECT_EQ(layer_.particleCount(), 0u);
  step({pressingMiddle(), pressingMiddle()}, 50);  // the next patch has not come yet
  for (const FingertipContact& contact : layer_.contacts().values) {
    EXPECT_FALSE(contact.touching);
    EXPECT_EQ(contact.force, Vector3d::Zero());
  }
  EXPECT_TRUE(layer_.loads().empty());
  EXPECT_EQ(left->positions(), places) << "nobody steps what was left";
}

TEST_F(HapticLayerTest, AFingertipWithANumberThatIsNoneIsTreatedAsAbsent) {
  receiveRest();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Fingertip sound = pressingMiddle();
  std::vector<Fingertip> unsound(5, sound);
  unsound[0].position.y() = nan;
  unsound[1].velocity.z() = std::numeric_limits<double>::infinity();
  unsound[2].angular_velocity.x() = nan;
  unsound[3].orientation.w() = nan;
  unsound[4].radius = nan;
  for (const Fingertip& fingertip : unsound) {
    step({sound, std::nullopt}, 20);
    ASSERT_TRUE(layer_.contacts()[Finger::kIndex].touching);
    step({fingertip, std::nullopt});
    EXPECT_TRUE(layer_.lastStepAccepted());
    EXPECT_FALSE(layer_.contacts()[Finger::kIndex].touching);
    EXPECT_EQ(layer_.contacts()[Finger::kIndex].force, Vector3d::Zero());
  }
}

TEST_F(HapticLayerTest, AnUnsoundFingertipDoesNotTakeTheOtherOnesForce) {
  receiveRest();
  Fingertip thumb = pressingMiddle();
  thumb.position.x() = std::nan("");
  step({pressingMiddle(), thumb}, 20);
  EXPECT_GT(layer_.contacts()[Finger::kIndex].force.norm(), 0.0);
}

TEST_F(HapticLayerTest, GoesOnAfterAFingertipThatIsFarTooDeep) {
  receiveRest();
  Fingertip fingertip = pressingMiddle();
  fingertip.velocity.x() = -1e200;
  step({fingertip, std::nullopt}, 3);
  EXPECT_TRUE(layer_.contacts()[Finger::kIndex].force.allFinite());
  receiveRest();
  step({std::nullopt, std::nullopt}, 5);
  step({pressingMiddle(), std::nullopt}, 50);
  EXPECT_TRUE(layer_.lastStepAccepted());
  EXPECT_TRUE(layer_.contacts()[Finger::kIndex].touching);
}

TEST_F(HapticLayerTest, AnExchangeWithoutContactChangesNoForceAndGivesTheOldPatchBack) {
  receiveRest();
  const Patch* before = layer_.patch();
  const std::unique_ptr<Patch> old =
      layer_.exchange(layer_.preparePatch({0, 1, 2}, nothingAttached(mesh_)));
  EXPECT_EQ(old.get(), before);
  step({std::nullopt, std::nullopt});
  EXPECT_EQ(layer_.contacts()[Finger::kIndex].force, Vector3d::Zero());
  EXPECT_TRUE(layer_.loads().empty());
}

TEST_F(HapticLayerTest, WithoutAPatchThereIsNoForce) {
  receiveRest();
  step({pressingMiddle(), std::nullopt}, 50);
  EXPECT_NE(layer_.exchange(nullptr), nullptr);
  EXPECT_EQ(layer_.patch(), nullptr);
  EXPECT_EQ(layer_.particleCount(), 0u);
  EXPECT_EQ(layer_.contacts()[Finger::kIndex].force, Vector3d::Zero());
  step({pressingMiddle(), std::nullopt});
  EXPECT_FALSE(layer_.contacts()[Finger::kIndex].touching);
}

TEST_F(HapticLayerTest, NoTrianglesOrNothingFreeIsNoPatch) {
  EXPECT_EQ(layer_.preparePatch({}, nothingAttached(mesh_)), nullptr);
  EXPECT_EQ(layer_.preparePatch(middle_, std::vector<char>(mesh_.rest_coordinates.size(), 1)),
            nullptr);
}

TEST_F(HapticLayerTest, TakesTrianglesInAnyOrderAndRepeated) {
  std::vector<int> shuffled(middle_.rbegin(), middle_.rend());
  shuffled.insert(shuffled.end(), middle_.begin(), middle_.end());
  const auto patch = layer_.preparePatch(shuffled, nothingAttached(mesh_));
  EXPECT_EQ(patch->particleCount(), layer_.particleCount());
}

TEST_F(HapticLayerTest, RefusesTrianglesThatDoNotExistAndAttachedOfAnotherSize) {
  EXPECT_EQ(refusalOf([&] {
              layer_.preparePatch({0, 128}, nothingAttached(mesh_));
            }),
            "triangle 128 does not exist; the cloth has triangles 0 to 127");
  EXPECT_EQ(refusalOf([&] {
              layer_.preparePatch({-1, 5}, nothingAttached(mesh_));
            }),
            "triangle -1 does not exist; the cloth has triangles 0 to 127");
  EXPECT_EQ(refusalOf([&] {
              layer_.preparePatch({0}, {1, 0});
            }),
            "attached has 2 entries; the cloth has 81 particles");
}

TEST_F(HapticLayerTest, RefusesStatesThatAreNoneAndKeepsTheOneItHas) {
  receiveRest();
  std::vector<Vector3d> bad = mesh_.initial_positions;
  bad[3].z() = std::nan("");
  EXPECT_EQ(refusalOf([&] { layer_.receive(bad, atRest(mesh_), 0.02); }),
            "the state has a number that is not finite");
  EXPECT_EQ(refusalOf([&] { layer_.receive(mesh_.initial_positions, bad, 0.02); }),
            "the state has a number that is not finite");
  EXPECT_EQ(refusalOf([&] { layer_.receive(mesh_.initial_positions, atRest(mesh_), 0.0); }),
            "the period of the state is 0 s; it must be finite and > 0");
  EXPECT_EQ(refusalOf([&] { layer_.receive(mesh_.initial_positions, atRest(mesh_), NAN); }),
            "the period of the state is nan s; it must be finite and > 0");
  bad.pop_back();
  EXPECT_EQ(refusalOf([&] { layer_.receive(bad, atRest(mesh_), 0.02); }),
            "the state has 80 positions and 81 velocities; the cloth has 81 particles");
  step({pressingMiddle(), std::nullopt}, 20);
  EXPECT_TRUE(layer_.lastStepAccepted());
  EXPECT_TRUE(layer_.contacts()[Finger::kIndex].touching);
}

TEST_F(HapticLayerTest, LoadsGoAheadWithBothFingertipsOfAPinchThatMove) {
  constexpr double kPeriod = 0.02;  // s, of receiveRest()
  receiveRest();
  Fingertip index = pressingMiddle(), thumb = index;
  thumb.position.x() = -index.position.x();  // the sheet lies in x = 0
  step({index, thumb}, 300);
  // Of the places that the loads refer to from their places on the cloth, which rests.
  const auto largest_shift_from = [&](const Vector3d& shift) {
    double most = layer_.loads().empty() ? 1.0 : 0.0;
    for (const cloth::PointLoad& load : layer_.loads()) {
      Vector3d place = Vector3d::Zero();
      for (int i = 0; i < 3; ++i) {
        place += load.weights[i] * mesh_.initial_positions[mesh_.triangles[load.triangle][i]];
      }
      most = std::max(most, (load.position - place - shift).norm());
    }
    return most;
  };
  EXPECT_LT(largest_shift_from(Vector3d::Zero()), 1e-12);
  // Together, to the index's side and away from it: the cloth goes along.
  for (const double speed : {0.1, -0.1}) {
    index.velocity.x() = thumb.velocity.x() = speed;
    step({index, thumb});
    EXPECT_LT(largest_shift_from({kPeriod * speed, 0.0, 0.0}), 1e-12);
  }
  // One that withdraws alone takes no more than its force away.
  index.velocity.x() = 0.1;
  thumb.velocity.x() = 0.0;
  step({index, thumb});
  EXPECT_LT(largest_shift_from(Vector3d::Zero()), 0.5 * kPeriod * 0.1);
}

TEST_F(HapticLayerTest, RefusesAFabricWithoutWhatContactNeeds) {
  material::Fabric fabric = wool();
  fabric.bending.reset();
  EXPECT_EQ(refusalOf([&] { HapticLayer(mesh_, fabric, {}, {}); }),
            "fabric 'wool' has no bending; a patch needs it: add the key bending");
  HapticSettings whole;
  whole.layer = HapticSettings::Layer::kWholeCloth;
  EXPECT_NO_THROW(HapticLayer(mesh_, fabric, {}, whole));
  fabric.friction.reset();
  EXPECT_NE(refusalOf([&] { HapticLayer(mesh_, fabric, {}, whole); }).find("'friction'"),
            std::string::npos);
}

TEST_F(HapticLayerTest, RefusesParticlesThatAreTied) {
  mesh::ClothMesh tied = mesh_;
  tied.ties.push_back({0, {1, 2}, 0.5});
  EXPECT_EQ(refusalOf([&] { HapticLayer(tied, wool(), {}, {}); }),
            "fingertips touch panels that are merged, and 1 particles of the mesh are tied");
}

TEST_F(HapticLayerTest, InAWholeClothSceneTheLargeScaleParticlesAreTouched) {
  HapticSettings settings;
  settings.layer = HapticSettings::Layer::kWholeCloth;
  HapticLayer layer(mesh_, wool(), {}, settings);
  layer.receive(mesh_.initial_positions, atRest(mesh_), 1e-3);
  layer.step({pressing(layer.law(), kSmallSampleMiddle, 2e-4), std::nullopt});
  EXPECT_TRUE(layer.contacts()[Finger::kIndex].touching);
  ASSERT_EQ(layer.loads().size(), 1u);
  EXPECT_NEAR((layer.loads()[0].force + layer.contacts()[Finger::kIndex].force).norm(), 0.0, 1e-15);
  EXPECT_EQ(layer.loads()[0].weights.maxCoeff(), 1.0);
}

}  // namespace
}  // namespace haptex::contact::test_haptic_layer
