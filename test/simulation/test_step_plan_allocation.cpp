// An executable of its own, because it counts every call of malloc in the process.
#include <gtest/gtest.h>

#include "../malloc_counter.h"
#include "haptex/simulation/force_sources.h"
#include "step_plans.h"

namespace haptex::simulation::test_step_plan_allocation {
namespace {

TEST(StepPlanAllocation, StepsAndChangesAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.setController(QualityController({1, 2, 3, 4}, 1e9, 0.005, 0));
  const std::size_t plans = severalPlans().size();
  const long before = allocations;
  bool accepted = true;
  for (int i = 0; i < 400; ++i) accepted = simulation.step() && accepted;
  for (int i = 0; i < 40; ++i) {
    simulation.use(static_cast<std::size_t>(i) % plans);
    accepted = simulation.step() && accepted;
  }
  const CycleTimes times = simulation.controller()->times();
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(accepted);
  EXPECT_EQ(simulation.controller()->changes(), 3u);
  EXPECT_EQ(times.cycles, 200u);
  EXPECT_GT(before, 0) << "the count does not work";
}

TEST(StepPlanAllocation, AdaptiveStepsAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  for (const StepPlan& plan : severalPlans()) {
    SimulatedCloth simulation =
        plannedSimulation({{plan.step, 1, 1, cloth::AdaptiveSteps{1e-4, 0.005, 1e-6}}}, true);
    const long before = allocations;
    bool accepted = true;
    int repeated = 0;
    for (int i = 0; i < 40; ++i) {
      simulation.setPointLoads({});
      accepted = simulation.step() && accepted;
      repeated += simulation.lastAdaptiveReport().repeated;
    }
    EXPECT_EQ(allocations - before, 0);
    EXPECT_TRUE(accepted);
    EXPECT_GT(repeated, 0);
  }
}

TEST(StepPlanAllocation, StepsWithFramesThatMoveAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.attach({0, 1}, "hand", Eigen::Isometry3d::Identity());
  simulation.step();
  const long before = allocations;
  for (int i = 1; i <= 40; ++i) {
    simulation.moveFrame(0, Eigen::Isometry3d(Eigen::Translation3d(1e-4 * i, 0.0, 0.0)));
    simulation.step();
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(StepPlanAllocation, StepsOfAPartAllocateNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.exclude({0, 1, 5, 6});
  const std::size_t plans = severalPlans().size();
  const long before = allocations;
  bool accepted = true;
  for (int i = 0; i < 40; ++i) {
    simulation.use(static_cast<std::size_t>(i) % plans);
    simulation.setPointLoads({});
    accepted = simulation.step() && accepted;
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(accepted);
}

TEST(StepPlanAllocation, ExternalForcesComeAndEndWithoutAllocation) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer brings its own malloc";
#endif
  SimulatedCloth simulation = smallSimulation();
  ForceSources sources(kSmallParticles);
  sources.set("wind", {{0, 1}, {{0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}}, 0.02});
  sources.set("magnet", {{1, 2}, {{0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}}, 0.05});
  const long before = allocations;
  bool accepted = true;
  for (int i = 0; i < 20; ++i) {
    sources.apply(simulation);
    accepted = simulation.step() && accepted;
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_TRUE(accepted);
  EXPECT_EQ(sources.size(), 0u);
}

}  // namespace
}  // namespace haptex::simulation::test_step_plan_allocation
