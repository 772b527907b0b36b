#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "step_plans.h"

namespace haptex::simulation::test_fastening {
namespace {

using cloth::ClothPlace;
using cloth::Fastener;
using cloth::FastenerKind;

/// From the lower corners of the small scene, 0.2 m apart, to each other and to the middle.
scene::Scene fastenedScene() {
  scene::Scene scene = smallScene();
  const ClothPlace left{{0, -1, -1}}, right{{4, -1, -1}}, middle{{12, -1, -1}};
  scene.effects.fasteners = {
      {"hem", FastenerKind::kElastic, {left, right}, 5.0, 0.15, 1.0},
      {"pleat", FastenerKind::kElastic, {left, middle}, 5.0, 0.2, 1.0, false},
      {"hook", FastenerKind::kHook, {right, middle}, 100.0, 0.0, 1.0, false}};
  return scene;
}

SimulatedCloth fastened() { return SimulatedCloth(fastenedScene(), smallFabric()); }

TEST(Fastening, OpensAndClosesByName) {
  SimulatedCloth simulation = fastened();
  EXPECT_TRUE(simulation.isFastened(0));
  EXPECT_FALSE(simulation.isFastened(1));
  EXPECT_NEAR(simulation.fastenerForce(0), 0.25, 1e-12);
  EXPECT_EQ(simulation.fastenerForce(1), 0.0);
  simulation.unfasten({"hem"});
  EXPECT_FALSE(simulation.isFastened(0));
  EXPECT_EQ(simulation.fastenerForce(0), 0.0);
  simulation.fasten({"pleat", "hem"});
  EXPECT_TRUE(simulation.isFastened(0));
  EXPECT_TRUE(simulation.isFastened(1));
  ASSERT_TRUE(simulation.step());
  simulation.unfasten({});
  for (std::size_t f = 0; f < 3; ++f) EXPECT_FALSE(simulation.isFastened(f));
  EXPECT_TRUE(simulation.openedFasteners().empty()) << "they were opened by hand";
}

TEST(Fastening, RefusesUnknownNamesAndPlacesThatAreTooFarApart) {
  expectRefused(
      fastened,
      [](SimulatedCloth& cloth) {
        cloth.fasten({"pleat", "collar"});
      },
      "names[1] = 'collar' is no fastener: allowed are hem, pleat, hook");
  expectRefused(
      fastened, [](SimulatedCloth& cloth) { cloth.unfasten({"collar"}); },
      "names[0] = 'collar' is no fastener");
  expectRefused(
      fastened, [](SimulatedCloth& cloth) { cloth.fasten({}); },
      "fastener 'hook' cannot be fastened: its places are 0.1414213562 m apart; allowed "
      "are 0.01 m");
  expectRefused([] { return smallSimulation(); }, [](SimulatedCloth& cloth) { cloth.fasten({}); },
                "the scene has no fasteners");
  scene::Scene apart = fastenedScene();
  apart.effects.fasteners[2].fastened = true;
  EXPECT_THROW(SimulatedCloth(apart, smallFabric()), std::invalid_argument);
}

TEST(Fastening, TellsOnceWhatAStepOpens) {
  SimulatedCloth simulation = fastened();
  simulation.attach({0, 4});
  simulation.move({4}, {0.0, 0.3, 0.0}, 0.5);
  std::vector<OpenedFastener> opened;
  for (int i = 0; i < 120; ++i) {
    ASSERT_TRUE(simulation.step());
    for (const OpenedFastener& one : simulation.openedFasteners()) opened.push_back(one);
    const double force = simulation.fastenerForce(0);
    EXPECT_LE(force, 1.0);
  }
  ASSERT_EQ(opened.size(), 1u);
  EXPECT_EQ(opened[0].fastener, 0u);
  EXPECT_EQ(opened[0].force, 1.0);
  EXPECT_FALSE(simulation.isFastened(0));
  simulation.reset();
  EXPECT_TRUE(simulation.isFastened(0));
  EXPECT_TRUE(simulation.openedFasteners().empty());
}

TEST(Fastening, StaysAsItIsWhenStateOrFabricIsChanged) {
  SimulatedCloth simulation = fastened();
  simulation.unfasten({"hem"});
  simulation.fasten({"pleat"});
  simulation.setState({}, simulation.state().positions, {});
  simulation.setFabric(smallFabric());
  ASSERT_TRUE(simulation.step());
  EXPECT_FALSE(simulation.isFastened(0));
  EXPECT_TRUE(simulation.isFastened(1));
}

/// A step that is rejected, or repeated in shorter ones, opens nothing.
TEST(Fastening, StepsThatAreTakenBackOpenNothing) {
  scene::Scene scene = fastenedScene();
  SimulatedCloth simulation(scene, smallFabric());
  const double huge = std::numeric_limits<double>::max();
  simulation.setExternalForce(4, {huge, huge, huge});
  ASSERT_FALSE(simulation.step());
  EXPECT_TRUE(simulation.isFastened(0));
  EXPECT_TRUE(simulation.openedFasteners().empty());
}

TEST(Fastening, WakesClothThatSleeps) {
  scene::Scene scene = fastenedScene();
  scene.effects.gravity.setZero();
  scene.effects.fasteners[0].fastened = false;
  SimulatedCloth simulation(scene, smallFabric());
  for (int i = 0; i < 4000 && !simulation.asleep(); ++i) ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(simulation.asleep());
  simulation.fasten({"pleat"});
  EXPECT_FALSE(simulation.asleep());
  const auto before = simulation.state().positions;
  simulation.fasten({"hem"});
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(simulation.step());
  EXPECT_NE(simulation.state().positions, before);
}

/// Excluded particles stand still, and what they are fastened to hangs on them.
TEST(Fastening, HoldsToExcludedParticlesAsToAttachedOnes) {
  for (const bool bending : {false, true}) {
    scene::Scene scene = fastenedScene();
    scene.effects.bending = bending;
    scene.step.tolerance = 1e-12;
    SimulatedCloth excluding(scene, smallFabric()), attaching(scene, smallFabric());
    excluding.exclude({4, 9, 3});
    attaching.attach({4, 9, 3});
    for (int i = 0; i < 50; ++i) {
      ASSERT_TRUE(excluding.step());
      ASSERT_TRUE(attaching.step());
    }
    EXPECT_GT(excluding.fastenerForce(0), 0.0);
    for (std::size_t i = 0; i < kSmallParticles; ++i) {
      EXPECT_LT((excluding.state().positions[i] - attaching.state().positions[i]).norm(), 1e-9)
          << i;
    }
    excluding.setExternalForce(0, {0.0, -60.0, 0.0});
    for (int i = 0; i < 200 && excluding.isFastened(0); ++i) ASSERT_TRUE(excluding.step());
    EXPECT_FALSE(excluding.isFastened(0));
    excluding.include({});
    EXPECT_FALSE(excluding.isFastened(0));
    ASSERT_TRUE(excluding.step());
  }
}

/// Every plan, also in substeps of adaptive length.
TEST(Fastening, OpensByEveryPlan) {
  std::vector<StepPlan> plans = severalPlans();
  plans.push_back({plans.front().step, 1, 1, cloth::AdaptiveSteps{1e-4, 0.005, 1e-5}});
  for (const StepPlan& plan : plans) {
    SimulatedCloth simulation(fastenedScene(), smallFabric(), {plan});
    simulation.attach({0, 4});
    simulation.move({4}, {0.0, 0.3, 0.0}, 0.5);
    int opened = 0;
    for (int i = 0; i < 150; ++i) {
      ASSERT_TRUE(simulation.step());
      opened += static_cast<int>(simulation.openedFasteners().size());
    }
    EXPECT_EQ(opened, 1) << nameOf(plan.step.method);
  }
}

}  // namespace
}  // namespace haptex::simulation::test_fastening
