#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/simulation/force_sources.h"
#include "haptex/simulation/real_time_loop.h"
#include "small_scene.h"

namespace haptex::simulation::test_real_time_loop {
namespace {

void ignore(const SimulatedCloth& /*simulation*/, double /*until_next*/) {}

cloth::ClothState stateOf(RealTimeLoop& loop) {
  cloth::ClothState state;
  loop.execute([&](SimulatedCloth& simulation) { state = simulation.state(); });
  return state;
}

// So stiff that its forces overflow a double.
void setOverflowingFabric(SimulatedCloth& simulation) {
  material::Fabric fabric = simulation.cloth().fabric();
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e308);
  simulation.setFabric(fabric);
}

TEST(RealTimeLoop, StandsStillWhilePaused) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  loop.setPaused(true);
  const cloth::ClothState before = stateOf(loop);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // ten steps, if it ran
  const cloth::ClothState after = stateOf(loop);
  EXPECT_EQ(before.time, after.time);
  EXPECT_EQ(before.positions, after.positions);
  EXPECT_TRUE(loop.status().paused);
}

TEST(RealTimeLoop, TakesExactlyTheStepsAskedFor) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  loop.setPaused(true);
  loop.execute([](SimulatedCloth& simulation) { simulation.reset(); });
  const StepsRun taken = loop.runSteps(17);
  EXPECT_EQ(taken.steps, 17u);
  EXPECT_EQ(taken.end, StepsRun::End::kAllRun);
  SimulatedCloth alone = smallSimulation();
  for (int i = 0; i < 17; ++i) alone.step();
  EXPECT_EQ(stateOf(loop).positions, alone.state().positions);
  EXPECT_EQ(loop.status().steps, 17u);
}

// Which other threads send meanwhile.
TEST(RealTimeLoop, LetsExternalForcesLiveInItsOwnTime) {
  ForceSources sources(kSmallParticles);
  RealTimeLoop loop(smallSimulation(), ignore,
                    [&](SimulatedCloth& simulation) { sources.apply(simulation); });
  loop.start();
  for (int i = 0; i < 50; ++i) {
    sources.set("wind", {{0}, {Eigen::Vector3d(1e-4 * i, 0.0, 0.0)}, 3600.0});
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  sources.set("magnet", {{1}, {Eigen::Vector3d(0.0, 0.01, 0.0)}, 2 * 0.005});
  loop.setPaused(true);
  loop.execute([&](SimulatedCloth& simulation) {
    sources.clear();
    simulation.reset();
  });
  sources.set("magnet", {{1}, {Eigen::Vector3d(0.0, 0.01, 0.0)}, 2 * 0.005});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // four steps, if it ran
  loop.runSteps(4);
  SimulatedCloth alone = smallSimulation();
  for (int i = 0; i < 4; ++i) {
    alone.setExternalForce(1, Eigen::Vector3d(0.0, i < 2 ? 0.01 : 0.0, 0.0));
    alone.step();
  }
  EXPECT_EQ(stateOf(loop).positions, alone.state().positions);
}

TEST(RealTimeLoop, RefusesStepsWhileRunning) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  EXPECT_THROW(loop.runSteps(1), std::invalid_argument);
}

TEST(RealTimeLoop, CarriesOutCommandsBetweenRequestedSteps) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  loop.setPaused(true);
  auto steps = std::async(std::launch::async, [&] { return loop.runSteps(4000000000u); });
  while (loop.status().steps < 10) std::this_thread::yield();
  EXPECT_THROW(loop.runSteps(1), std::invalid_argument);  // one caller at once
  loop.setPaused(false);
  EXPECT_EQ(steps.get().end, StepsRun::End::kInterrupted);
}

TEST(RealTimeLoop, RethrowsWhatACommandThrows) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  EXPECT_THROW(loop.execute([](SimulatedCloth&) { throw std::domain_error("no"); }),
               std::domain_error);
  EXPECT_NO_THROW(stateOf(loop));
}

TEST(RealTimeLoop, StepsOnUnderAStreamOfCommands) {
  std::atomic<bool> stop{false};
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  auto stream = std::async(std::launch::async, [&] {
    while (!stop) loop.execute([](SimulatedCloth&) {});
  });
  while (loop.status().steps < 20) std::this_thread::yield();  // a starved loop would hang here
  stop = true;
}

TEST(RealTimeLoop, KeepsTheLastGoodStateWhenAStepIsRejected) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  loop.setPaused(true);
  loop.runSteps(3);
  const cloth::ClothState good = stateOf(loop);
  loop.execute(setOverflowingFabric);
  const StepsRun taken = loop.runSteps(5);
  EXPECT_EQ(taken.steps, 0u);
  EXPECT_EQ(taken.end, StepsRun::End::kRejected);
  EXPECT_EQ(stateOf(loop).positions, good.positions);
  EXPECT_TRUE(loop.status().last_step_rejected);
  EXPECT_EQ(loop.status().rejected_steps, 1u);
}

TEST(RealTimeLoop, ShowsTheLastGoodStateAfterCommandsWhileStepsAreRejected) {
  std::atomic<int> shown{0};
  RealTimeLoop loop(smallSimulation(),
                    [&](const SimulatedCloth& /*simulation*/, double until_next) {
                      shown += until_next == RealTimeLoop::kNever;
                    });
  loop.start();
  loop.execute(setOverflowingFabric);
  while (!loop.status().last_step_rejected) std::this_thread::yield();
  loop.execute([](SimulatedCloth&) {});
  while (shown == 0) std::this_thread::yield();  // a loop that shows nothing would hang here
}

TEST(RealTimeLoop, TellsWhenTheNextStepBegins) {
  const double step = smallSimulation().timeStep();
  std::vector<double> told;
  RealTimeLoop loop(smallSimulation(),
                    [&](const SimulatedCloth& /*simulation*/, double until_next) {
                      if (until_next != RealTimeLoop::kNever) told.push_back(until_next);
                    });
  loop.start();
  while (loop.status().steps < 20) std::this_thread::yield();
  loop.stop();
  ASSERT_FALSE(told.empty());
  EXPECT_GE(*std::min_element(told.begin(), told.end()), 0.0);
  const double longest = *std::max_element(told.begin(), told.end());
  EXPECT_LE(longest, step);
  if (!base::kSanitized) {
    EXPECT_GT(longest, 0.0) << "the loop never has time left";
  }
}

TEST(RealTimeLoop, TellsThatRequestedStepsFollowAtOnceUntilTheLast) {
  std::vector<double> told;
  RealTimeLoop loop(smallSimulation(), [&](const SimulatedCloth& /*simulation*/,
                                           double until_next) { told.push_back(until_next); });
  loop.start();
  loop.setPaused(true);
  loop.runSteps(3);
  loop.stop();
  ASSERT_GE(told.size(), 3u);
  EXPECT_EQ(std::vector<double>(told.end() - 3, told.end()),
            (std::vector<double>{0.0, 0.0, RealTimeLoop::kNever}));
}

TEST(RealTimeLoop, ShowsEveryAcceptedStepOnce) {
  std::vector<std::uint64_t> seen;
  RealTimeLoop loop(smallSimulation(), [&](const SimulatedCloth& simulation, double until_next) {
    if (until_next != RealTimeLoop::kNever) seen.push_back(simulation.steps());
  });
  loop.start();
  while (loop.status().steps < 10) std::this_thread::yield();
  loop.stop();
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
  EXPECT_GE(seen.size(), 10u);
}

TEST(RealTimeLoop, RefusesCommandsAfterItsEnd) {
  RealTimeLoop loop(smallSimulation(), ignore);
  loop.start();
  loop.stop();
  EXPECT_THROW(loop.execute([](SimulatedCloth&) {}), std::runtime_error);
}

/// The second plan takes one step of the scene at once, the first, cheaper one takes two.
SimulatedCloth governedSimulation() {
  scene::Scene scene = smallScene();
  const double cycle = scene.time_step;
  const cloth::StepSettings step = scene.step;
  SimulatedCloth simulation(std::move(scene), smallFabric(), {{step, 1, 2}, {step, 1, 1}});
  simulation.setController(QualityController({0.1 * cycle, 0.2 * cycle}, 0.8 * cycle, cycle, 1));
  return simulation;
}

TEST(RealTimeLoop, GivesUpNoTimeWhileALowerQualityIsLeft) {
  std::promise<std::size_t> plan_of_second;
  std::promise<void> second, third;
  int steps = 0;
  const auto beyond_backlog = std::chrono::duration<double>(1.5 * RealTimeLoop::kMaxBacklog);
  RealTimeLoop loop(governedSimulation(), ignore, [&](SimulatedCloth& simulation) {
    ++steps;
    if (steps == 2) {  // the first one has been accounted for
      plan_of_second.set_value(simulation.plan());
      second.get_future().wait();
    }
    if (steps == 3) third.get_future().wait();
    if (steps <= 2) std::this_thread::sleep_for(beyond_backlog);
  });
  loop.start();
  EXPECT_EQ(plan_of_second.get_future().get(), 0u);
  EXPECT_EQ(loop.status().dropped_seconds, 0.0);
  second.set_value();
  while (loop.status().steps < 2) std::this_thread::yield();
  EXPECT_GT(loop.status().simulated_time, 0.0);
  third.set_value();
  while (loop.status().steps < 3) std::this_thread::yield();
  EXPECT_GT(loop.status().dropped_seconds, 0.0);  // the cheapest was as late
}

TEST(RealTimeLoop, CountsTheWaitForItsTurnAsComputingTime) {
  std::promise<double> worst;
  int steps = 0;
  RealTimeLoop loop(governedSimulation(), ignore, [&](SimulatedCloth& simulation) {
    ++steps;
    if (steps == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (steps == 2) worst.set_value(simulation.controller()->times().worst);
  });
  loop.start();
  EXPECT_GE(worst.get_future().get(), 0.020);
}

}  // namespace
}  // namespace haptex::simulation::test_real_time_loop
