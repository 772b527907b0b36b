// An executable of its own, because it counts every call of malloc in the process.
// What scripts/bench features measures in full, with numbers that no other process disturbs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <ostream>
#include <string>
#include <vector>

#include "../malloc_counter.h"
#include "haptex/material/fabric_file.h"
#include "haptex/studies/feature_scenes.h"

namespace haptex::studies::test_feature_allocation {

void PrintTo(const Feature& feature, std::ostream* stream) { *stream << feature.name; }

namespace {

constexpr int kCells = 8;
constexpr int kSteps = 32;  // the first stroke

const FeatureScene& bare() {
  static const FeatureScene bare_scene =
      bareScene(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"), kCells);
  return bare_scene;
}

struct Allocations {
  long calls;
  long bytes;
};

template <typename Make>
Allocations allocationsOf(const Make& make) {
  const Allocations before{allocations, allocated_bytes};
  make();
  return {allocations - before.calls, allocated_bytes - before.bytes};
}

/// Of making the scene, without what the fabric says, and of some steps of it.
Allocations allocationsOf(const FeatureScene& scene) {
  const Allocations all = allocationsOf([&] {
    simulation::SteppedScene stepped = scene.stepped();
    stepped.secondsFor(kSteps);
  });
  const Allocations fabric = allocationsOf([&] { const material::Fabric copy = scene.fabric; });
  return {all.calls - fabric.calls, all.bytes - fabric.bytes};
}

std::vector<Eigen::Vector3d> positionsOf(const FeatureScene& scene) {
  simulation::SteppedScene stepped = scene.stepped();
  stepped.secondsFor(kSteps);
  return stepped.state().positions;
}

class EveryFeature : public testing::TestWithParam<Feature> {
 protected:
  static FeatureScene described() {
    FeatureScene scene = bare();
    GetParam().describe(scene);
    return scene;
  }
  static FeatureScene listed() {
    FeatureScene scene = described();
    GetParam().list(scene);
    return scene;
  }
};

TEST_P(EveryFeature, TakesNoMemoryUnlessItIsListed) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  const Allocations without = allocationsOf(bare());
  const Allocations unlisted = allocationsOf(described());
  EXPECT_EQ(unlisted.calls, without.calls);
  EXPECT_EQ(unlisted.bytes, without.bytes);
}

TEST_P(EveryFeature, IsNotComputedUnlessItIsListed) {
  EXPECT_EQ(positionsOf(described()), positionsOf(bare())) << "bit by bit";
}

// What is far away is there, and does nothing; everything else has to be seen, or the two tests
// above would not see it either.
TEST_P(EveryFeature, IsComputedWhereItIsListed) {
  const std::string& name = GetParam().name;
  const bool far = name.size() > 4 && name.substr(name.size() - 4) == "_far";
  EXPECT_EQ(positionsOf(listed()) != positionsOf(bare()), !far);
#ifndef __SANITIZE_ADDRESS__
  // The others go into what is there.
  const bool needs_memory = name != "gravity" && name != "viscosity" && name != "contraction";
  EXPECT_EQ(allocationsOf(listed()).bytes > allocationsOf(bare()).bytes, needs_memory);
#endif
}

INSTANTIATE_TEST_SUITE_P(Features, EveryFeature, testing::ValuesIn(features()),
                         [](const auto& info) { return info.param.name; });

TEST(SteppedScene, GoesThroughTheSameMotionAgain) {
  simulation::SteppedScene stepped = bare().stepped();
  const int steps = static_cast<int>(simulation::SteppedScene::kPeriod / stepped.timeStep());
  stepped.secondsFor(steps);
  const std::vector<Eigen::Vector3d> first = stepped.state().positions;
  EXPECT_NE(first, stepped.cloth().mesh().initial_positions);
  for (int i = 0; i < steps; ++i) stepped.step();
  // The solver remembers its last solution, and without weight the sheet is limp.
  double distance = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    distance = std::max(distance, (stepped.state().positions[i] - first[i]).norm());
  }
  EXPECT_LT(distance, 1e-3) << "of the 20 mm that it is shaken by";
}

TEST(StepCost, OfASceneAgainstItselfIsTheSame) {
  simulation::SteppedScene one = bare().stepped(), other = bare().stepped();
  const simulation::StepCost cost = simulation::compareSteps(one, other, 5, kSteps);
  EXPECT_GT(cost.seconds, 0.0);
  EXPECT_GT(cost.ratio, 0.0);
  EXPECT_GE(cost.noise, 0.0);
}

}  // namespace
}  // namespace haptex::studies::test_feature_allocation
