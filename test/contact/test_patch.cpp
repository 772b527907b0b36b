#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fixtures.h"

namespace haptex::contact::test_patch {
namespace {

using base::Finger;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

class PatchTest : public testing::Test {
 protected:
  PatchTest() : motion_(mesh_.rest_coordinates.size()) {
    motion_.receive(mesh_.initial_positions, 0.02);
  }
  Patch patchAround(const Eigen::Vector2d& place, double distance) const {
    return {mesh_,
            cutAndRefine(mesh_, topology_, trianglesAround(mesh_, place, distance),
                         nothingAttached(mesh_), 2),
            fabrics_, effects_, laws_};
  }
  /// The force of the fingertip on the cloth.
  static Vector3d forceOn(const Patch& patch) {
    Vector3d sum = Vector3d::Zero();
    for (const TouchedParticle& touched : patch.contact(Finger::kIndex).touched())
      sum += touched.force();
    return sum;
  }
  void advance(Patch& patch, const Fingertip* fingertip, int steps) {
    for (int i = 0; i < steps; ++i) {
      motion_.advance(kStep);
      ASSERT_TRUE(patch.advance(motion_, {fingertip, nullptr}, kStep));
    }
  }

  const mesh::ClothMesh mesh_ = smallSample();
  const MeshTopology topology_{mesh_};
  const std::vector<material::Fabric> fabrics_ = {wool()};
  const std::vector<ContactLaw> laws_ = {ContactLaw(fabrics_.front())};
  cloth::ModelledEffects effects_;
  LargeScaleMotion motion_;
};

TEST_F(PatchTest, StartsOnTheClothAndStaysThereAtRest) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  advance(patch, nullptr, 100);
  for (std::size_t i = 0; i < patch.particleCount(); ++i) {
    const int particle = static_cast<int>(i);
    const Eigen::Vector2d& rest = patch.restCoordinates(particle);
    EXPECT_NEAR((patch.positions()[i] - Vector3d(0.0, rest.x() - 0.02, rest.y() - 0.04)).norm(),
                0.0, 1e-12);
  }
}

TEST_F(PatchTest, ItsAreasSumToThoseOfItsTriangles) {
  const Patch patch = patchAround({0.02, 0.02}, 0.01);
  double sum = 0.0;
  for (double area : patch.areas()) sum += area;
  EXPECT_NEAR(sum, 0.02 * 0.02, 1e-15);
}

TEST_F(PatchTest, TheRimFollowsTheLargeScaleClothExactly) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  std::vector<Vector3d> moved = mesh_.initial_positions;
  for (Vector3d& position : moved) position += Vector3d(0.002, 0.001, -0.003);
  motion_.receive(moved, 0.02);
  advance(patch, nullptr, 7);
  for (int i = patch.freeCount(); i < static_cast<int>(patch.particleCount()); ++i) {
    EXPECT_NEAR((patch.positions()[i] - patch.placeOnCloth(i, motion_)).norm(), 0.0, 1e-15);
  }
  // Nothing but the rim pulls the rest along; in the end all is in place again.
  advance(patch, nullptr, 3000);
  for (int i = 0; i < patch.freeCount(); ++i) {
    EXPECT_NEAR((patch.positions()[i] - patch.placeOnCloth(i, motion_)).norm(), 0.0, 1e-6);
  }
}

/// A linear force: the exact displacement of a free fall, which linearised backward Euler has to
/// its own order, of a patch without rim.
TEST_F(PatchTest, AWholeClothFallsFreely) {
  effects_.gravity = {0.0, 0.0, -10.0};
  Patch patch = patchAround({0.02, 0.02}, 0.02);
  ASSERT_EQ(patch.freeCount(), static_cast<int>(patch.particleCount()));
  patch.start(motion_);
  const Vector3d before = patch.positions()[5];
  advance(patch, nullptr, 100);
  // Backward Euler: sum of i g h^2 over 100 steps.
  const double exact = -10.0 * kStep * kStep * 100 * 101 / 2;
  EXPECT_NEAR((patch.positions()[5] - before - Vector3d(0.0, 0.0, exact)).norm(), 0.0, 1e-12);
}

TEST_F(PatchTest, WhatTheFingertipPressesTheRimHolds) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(patch, &fingertip, 500);
  const Vector3d force = forceOn(patch);
  EXPECT_LT(force.x(), -0.01);
  EXPECT_NEAR(force.y(), 0.0, 1e-6);  // by symmetry
  double magnitudes = 0.0;
  for (double magnitude : patch.contactForces()) magnitudes += magnitude;
  EXPECT_GE(magnitudes, force.norm());
  // At rest each free particle balances: the contact force is all that moves it.
  double speed = 0.0;
  for (const Vector3d& velocity : patch.velocities()) speed = std::max(speed, velocity.norm());
  EXPECT_LT(speed, 1e-6);
}

TEST_F(PatchTest, OfClothThatCollidesWithItselfIsTheSameToTheBitWhereItIsOneLayer) {
  effects_.viscosity = true;
  const auto pinched = [&](bool self_collision) {
    effects_.self_collision = self_collision;
    const std::vector<ContactLaw> laws = {
        ContactLaw(fabrics_.front(), {}, self_collision ? LayersBetween::kMost : 1)};
    Patch patch(mesh_,
                cutAndRefine(mesh_, topology_, trianglesAround(mesh_, {0.02, 0.02}, 0.01),
                             nothingAttached(mesh_), 2),
                fabrics_, effects_, laws);
    LargeScaleMotion motion(mesh_.rest_coordinates.size());
    motion.receive(mesh_.initial_positions, 0.02);
    patch.start(motion);
    const Fingertip index = pressing(laws.front(), kSmallSampleMiddle, 4e-4);
    Fingertip thumb = index;
    thumb.position.x() *= -1.0;
    for (int i = 0; i < 100; ++i) {
      motion.advance(kStep);
      EXPECT_TRUE(patch.advance(motion, {&index, &thumb}, kStep));
    }
    EXPECT_LT(forceOn(patch).x(), -0.01);
    return std::make_pair(patch.positions(), forceOn(patch));
  };
  EXPECT_EQ(pinched(true), pinched(false));
}

TEST_F(PatchTest, ForgetsContactWhenTheFingertipIsGoneAndReturnsToRest) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(patch, &fingertip, 100);
  ASSERT_FALSE(patch.contact(Finger::kIndex).touched().empty());
  advance(patch, nullptr, 1);
  EXPECT_TRUE(patch.contact(Finger::kIndex).touched().empty());
  for (double force : patch.contactForces()) EXPECT_EQ(force, 0.0);
}

TEST_F(PatchTest, AnotherPatchGoesOnWithTheStateOfWhatBothHave) {
  Patch here = patchAround({0.02, 0.02}, 0.01);
  here.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(here, &fingertip, 200);
  Patch there = patchAround({0.02, 0.025}, 0.01);
  there.goOnFrom(here, motion_);
  int shared = 0;
  for (int i = 0; i < here.freeCount(); ++i) {
    for (int j = 0; j < there.freeCount(); ++j) {
      if (!(here.cut().supports[i] == there.cut().supports[j])) continue;
      ++shared;
      EXPECT_EQ(here.positions()[i], there.positions()[j]);
      EXPECT_EQ(here.velocities()[i], there.velocities()[j]);
    }
  }
  EXPECT_EQ(shared, 15 * 11);  // inner particles of 4 x 3 cells at 4 divisions
}

TEST_F(PatchTest, AnExchangeUnderContactDoesNotLetTheForceJump) {
  Patch here = patchAround({0.02, 0.02}, 0.01);
  here.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(here, &fingertip, 500);
  const Vector3d before = forceOn(here);
  Patch there = patchAround({0.02, 0.025}, 0.01);
  there.goOnFrom(here, motion_);
  Vector3d last = before;
  for (int i = 0; i < 100; ++i) {
    advance(there, &fingertip, 1);
    EXPECT_LT((forceOn(there) - last).norm(), 0.02) << "step " << i;
    last = forceOn(there);
  }
}

TEST_F(PatchTest, WhatIsRefinedInAnExchangeStaysWhereItWas) {
  const std::vector<int> inner = trianglesAround(mesh_, {0.02, 0.02}, 0.005);
  const std::vector<int> outer = trianglesAround(mesh_, {0.02, 0.02}, 0.01);
  const auto patchOf = [&](const std::vector<int>& refined, const std::vector<int>& around) {
    return Patch(mesh_, cutAndRefine(mesh_, topology_, refined, nothingAttached(mesh_), 2, around),
                 fabrics_, effects_, laws_);
  };
  Patch here = patchOf(inner, trianglesAround(mesh_, topology_, inner, 0.01, 1000));
  here.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(here, &fingertip, 200);
  Patch there = patchOf(outer, {});
  there.goOnFrom(here, motion_);
  double moved = 0.0;
  for (int i = 0; i < there.freeCount(); ++i) {
    Vector3d place = Vector3d::Zero();
    const std::array<int, 3>& corners = mesh_.triangles[there.cut().owners[i]];
    const int element = there.cut().owners[i];
    const auto& elements = here.cut().elements;
    const auto whole =
        std::find(elements.begin() + here.cut().refined_count, elements.end(), element);
    if (whole == elements.end()) continue;
    for (int k = 0; k < 3; ++k) {
      place += there.cut().weights[i][k] * here.positions()[cornerIn(here.cut(), corners[k])];
    }
    const bool shared = std::count(here.cut().supports.begin(), here.cut().supports.end(),
                                   there.cut().supports[i]) > 0;
    if (shared) continue;
    EXPECT_NEAR((there.positions()[i] - place).norm(), 0.0, 1e-12);
    moved = std::max(moved, (place - there.placeOnCloth(i, motion_)).norm());
  }
  EXPECT_GT(moved, 1e-5) << "nothing is off the large-scale cloth";
}

// Contact comes, slips and goes while the large-scale cloth moves.
TEST_F(PatchTest, AStepWithAnOldFactorIsThatOfANewOne) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  std::vector<Vector3d> state = mesh_.initial_positions;
  double most_force = 0.0;
  bool slipped = false;
  for (int i = 0; i < 600; ++i) {
    if (i % 20 == 0) {
      for (Vector3d& position : state) position.x() += 2e-4 * std::cos(0.01 * i);
      motion_.receive(state, 0.02);
    }
    Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1.5e-3 * std::sin(0.02 * i));
    fingertip.position.z() += 2e-3 * std::sin(0.03 * i);
    const bool compared = i % 13 == 0;
    std::optional<Patch> anew;
    if (compared) anew.emplace(patchAround({0.02, 0.02}, 0.01)).goOnFrom(patch, motion_);
    advance(patch, &fingertip, 1);
    most_force = std::max(most_force, forceOn(patch).norm());
    for (const TouchedParticle& touched : patch.contact(Finger::kIndex).touched()) {
      slipped = slipped || touched.slips;
    }
    if (!compared) continue;
    ASSERT_TRUE(anew->advance(motion_, {&fingertip, nullptr}, kStep));
    EXPECT_NEAR((forceOn(patch) - forceOn(*anew)).norm(), 0.0, 1e-5) << i;
    for (std::size_t k = 0; k < patch.particleCount(); ++k) {
      ASSERT_NEAR((patch.positions()[k] - anew->positions()[k]).norm(), 0.0, 1e-7) << i;
    }
  }
  EXPECT_GT(most_force, 0.2);
  EXPECT_TRUE(slipped);
}

TEST_F(PatchTest, SaysWhenAStepIsNotFiniteAndStartsAgain) {
  Patch patch = patchAround({0.02, 0.02}, 0.01);
  patch.start(motion_);
  const Fingertip fingertip = pressing(laws_.front(), kSmallSampleMiddle, 1e-3);
  advance(patch, &fingertip, 1);
  LargeScaleMotion bad(mesh_.rest_coordinates.size());
  bad.receive(std::vector<Vector3d>(mesh_.rest_coordinates.size(), Vector3d(0.0, NAN, 0.0)), 0.02);
  EXPECT_FALSE(patch.advance(bad, {&fingertip, nullptr}, kStep));
  patch.start(motion_);
  advance(patch, &fingertip, 10);
  EXPECT_TRUE(forceOn(patch).allFinite());
}

}  // namespace
}  // namespace haptex::contact::test_patch
