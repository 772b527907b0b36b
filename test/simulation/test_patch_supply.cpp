#include <gtest/gtest.h>

#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/mesh/mesh.h"
#include "haptex/simulation/patch_supply.h"

namespace haptex::simulation::test_patch_supply {
namespace {

using base::Finger;

class PatchSupplyTest : public testing::Test {
 protected:
  PatchSupplyTest() {
    index_.fingertips[Finger::kIndex].emplace();
    index_.fingertips[Finger::kIndex]->radius = 7.5e-3;
    index_.state_period = 0.01;
  }

  static contact::HapticSettings carrying() {
    contact::HapticSettings settings;
    settings.surround = 0.06;
    return settings;
  }

  /// A search that finds these triangles, the nearest first, and counts how often it was asked.
  PatchSupply::Search finds(const std::vector<int>& triangles) {
    return
        [this, triangles](const contact::SearchVolume& volume, contact::PatchSelection& selection) {
          ++asked_;
          last_end_ = volume.end;
          for (std::size_t i = 0; i < triangles.size(); ++i) {
            selection.add(triangles[i], 1e-4 * static_cast<double>(i), static_cast<int>(i), {});
          }
          return true;
        };
  }

  const mesh::ClothMesh mesh_ =
      mesh::makeRectangle(0.04, 0.04, 8, 8, mesh::Triangulation::kAlternating);
  const contact::HapticLayer layer_{
      mesh_, material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"), {}, {}};
  const std::vector<char> nothing_attached_ = std::vector<char>(mesh_.rest_coordinates.size(), 0);
  PatchSupply supply_{carrying(), mesh_.triangles.size()};
  LoopView index_;
  int asked_ = 0;
  Eigen::Vector3d last_end_ = Eigen::Vector3d::Zero();
};

TEST_F(PatchSupplyTest, PreparesAPatchWhenTheAnswerHasChanged) {
  supply_.setAttached(nothing_attached_);
  EXPECT_FALSE(supply_.isOutdated()) << "there is nothing yet";
  EXPECT_TRUE(supply_.ask(index_, finds({40, 41, 42, 43, 56, 57, 58, 59})));
  ASSERT_TRUE(supply_.isOutdated());
  const auto patch = supply_.prepare(layer_);
  ASSERT_NE(patch, nullptr);
  EXPECT_EQ(supply_.triangles().size(), 8u);
  EXPECT_FALSE(supply_.isOutdated());
  EXPECT_TRUE(supply_.ask(index_, finds({40, 41, 42, 43, 56, 57, 58, 59})));
  EXPECT_FALSE(supply_.isOutdated());
}

TEST_F(PatchSupplyTest, AsksForEveryFingertipThatIsThereWhereItWillBe) {
  index_.state_period = 0.02;
  index_.fingertips[Finger::kIndex]->velocity = {0.1, 0.0, 0.0};
  EXPECT_TRUE(supply_.ask(index_, finds({})));
  EXPECT_EQ(asked_, 1);
  EXPECT_NEAR(last_end_.x(), 2e-3, 1e-15);
  index_.fingertips[Finger::kThumb] = index_.fingertips[Finger::kIndex];
  EXPECT_TRUE(supply_.ask(index_, finds({})));
  EXPECT_EQ(asked_, 3);
}

TEST_F(PatchSupplyTest, AFailedSearchChangesNothing) {
  supply_.setAttached(nothing_attached_);
  supply_.ask(index_, finds({40, 41}));
  supply_.prepare(layer_);
  const auto fails = [](const contact::SearchVolume&, contact::PatchSelection& selection) {
    selection.add(7, 0.0, 0, {});
    return false;
  };
  EXPECT_FALSE(supply_.ask(index_, fails));
  EXPECT_FALSE(supply_.isOutdated());
  EXPECT_EQ(supply_.triangles(), (std::vector<int>{40, 41}));
}

TEST_F(PatchSupplyTest, AnAttachmentAsksForAnotherPatch) {
  supply_.setAttached(nothing_attached_);
  supply_.ask(index_, finds({40, 41, 42}));
  supply_.prepare(layer_);
  supply_.setAttached(nothing_attached_);
  EXPECT_FALSE(supply_.isOutdated());
  std::vector<char> attached = nothing_attached_;
  attached[30] = 1;
  supply_.setAttached(attached);
  EXPECT_TRUE(supply_.isOutdated());
}

TEST_F(PatchSupplyTest, WhatIsTouchedStaysWhereverTheLargeScaleClothIs) {
  supply_.setAttached(nothing_attached_);
  supply_.ask(index_, finds({40, 41, 42}));
  supply_.prepare(layer_);
  for (const int triangle : {41, 50, 1000}) {  // the last one of a larger mesh
    index_.loads.push_back({triangle, Eigen::Vector3d(1, 0, 0), Eigen::Vector3d::Zero(),
                            Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  }
  supply_.ask(index_, finds({42, 43}));
  EXPECT_EQ(supply_.triangles(), (std::vector<int>{41, 42, 43}));
  index_.loads.clear();
  supply_.ask(index_, finds({42, 43}));
  EXPECT_EQ(supply_.triangles(), (std::vector<int>{42, 43}));
}

TEST_F(PatchSupplyTest, APinchOfClothThatNothingElseHoldsDoesNotWidenThePatch) {
  supply_.setAttached(nothing_attached_);
  const PatchSupply::Search search = finds({40, 41, 42, 43, 56, 57, 58, 59});
  supply_.ask(index_, search);
  supply_.prepare(layer_);
  index_.is_pinched = true;
  supply_.ask(index_, search);
  EXPECT_FALSE(supply_.isOutdated());
}

TEST_F(PatchSupplyTest, APinchWidensThePatchUntilItHasBeenOpenForAWhile) {
  std::vector<char> attached = nothing_attached_;
  attached[0] = 1;
  supply_.setAttached(attached);
  const PatchSupply::Search search = finds({40, 41, 42, 43, 56, 57, 58, 59});
  const auto particles = [&] { return supply_.prepare(layer_)->particleCount(); };
  supply_.ask(index_, search);
  const std::size_t touched = particles();
  index_.is_pinched = true;
  supply_.ask(index_, search);
  ASSERT_TRUE(supply_.isOutdated());
  EXPECT_GT(particles(), touched);
  index_.is_pinched = false;
  for (int round = 1; round < PatchSupply::kRests; ++round) {
    supply_.ask(index_, search);
    EXPECT_FALSE(supply_.isOutdated()) << round;
  }
  supply_.ask(index_, search);
  ASSERT_TRUE(supply_.isOutdated());
  EXPECT_EQ(particles(), touched);
}

TEST_F(PatchSupplyTest, NothingNearIsNoPatch) {
  supply_.setAttached(nothing_attached_);
  supply_.ask(index_, finds({40, 41}));
  supply_.prepare(layer_);
  supply_.ask(index_, finds({}));
  ASSERT_TRUE(supply_.isOutdated());
  EXPECT_EQ(supply_.prepare(layer_), nullptr);
}

}  // namespace
}  // namespace haptex::simulation::test_patch_supply
