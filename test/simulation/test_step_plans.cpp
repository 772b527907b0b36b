#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "step_plans.h"

namespace haptex::simulation::test_step_plans {
namespace {

void runSteps(SimulatedCloth& simulation, int count) {
  for (int i = 0; i < count; ++i) ASSERT_TRUE(simulation.step());
}

double fastest(const cloth::ClothState& state) {
  double speed = 0.0;
  for (const Eigen::Vector3d& velocity : state.velocities) {
    speed = std::max(speed, velocity.norm());
  }
  return speed;
}

void expectSame(const cloth::ClothState& state, const cloth::ClothState& other) {
  EXPECT_EQ(state.positions, other.positions);
  EXPECT_EQ(state.velocities, other.velocities);
  EXPECT_EQ(state.memory, other.memory);
  EXPECT_EQ(state.time, other.time);
}

TEST(StepPlans, SubstepsAreThoseOfTheIntegratorByHand) {
  for (std::size_t plan = 0; plan < severalPlans().size(); ++plan) {
    SimulatedCloth simulation = plannedSimulation();
    simulation.use(plan);
    const StepPlan by_hand = severalPlans()[plan];
    const cloth::Cloth& cloth = simulation.cloth();
    cloth::ClothState state = simulation.state();
    cloth::Integrator integrator(cloth, by_hand.step);
    const double substep = simulation.timeStep() / by_hand.substeps;
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE(simulation.step());
      int solves = 0;
      for (int j = 0; j < by_hand.substeps; ++j) {
        solves += integrator.step(cloth, state, substep).newton_iterations;
      }
      EXPECT_EQ(simulation.lastReport().newton_iterations, solves);
    }
    expectSame(simulation.state(), state);
    EXPECT_NEAR(state.time, 5 * simulation.timeStep(), 1e-15);
    EXPECT_EQ(simulation.steps(), 5u);
  }
}

TEST(StepPlans, ASceneWithoutThemRunsAsWithTheOneOfItsSettings) {
  SimulatedCloth plain = smallSimulation();
  SimulatedCloth planned = plannedSimulation({{cloth::StepSettings(), 1}});
  runSteps(plain, 10);
  runSteps(planned, 10);
  expectSame(plain.state(), planned.state());
}

TEST(StepPlans, UnderLoadsMethodsOfSecondOrderGiveWayToBackwardEuler) {
  for (const auto method : {cloth::IntegrationMethod::kBackwardMidpoint,
                            cloth::IntegrationMethod::kBdf2, cloth::IntegrationMethod::kTrBdf2}) {
    cloth::StepSettings step;
    SimulatedCloth damped = plannedSimulation({{step, 2}});
    step.method = method;
    SimulatedCloth undamped = plannedSimulation({{step, 2}});
    const cloth::PointLoad load{3,
                                Eigen::Vector3d::Constant(1.0 / 3.0),
                                Eigen::Vector3d::Zero(),
                                {0.01, 0.0, 0.0},
                                Eigen::Matrix3d::Zero()};
    for (SimulatedCloth* simulation : {&damped, &undamped}) simulation->setPointLoads({load});
    runSteps(damped, 5);
    runSteps(undamped, 5);
    expectSame(undamped.state(), damped.state());
    for (SimulatedCloth* simulation : {&damped, &undamped}) simulation->setPointLoads({});
    runSteps(damped, 1);
    runSteps(undamped, 1);
    EXPECT_NE(undamped.state().positions, damped.state().positions) << nameOf(method);
  }
}

TEST(StepPlans, AChangeLeavesTheStateAsItIs) {
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.move({kSmallTop}, {0.05, 0.1, 0.0}, 0.1);
  for (int change = 0; change < 12; ++change) {
    runSteps(simulation, 3);
    const cloth::ClothState before = simulation.state();
    simulation.use((5 * change + 1) % severalPlans().size());
    expectSame(simulation.state(), before);
  }
  EXPECT_GT(fastest(simulation.state()), 0.1);  // nothing of that was trivial
}

// In a step of 5 ms gravity changes velocities by 0.05 m/s: a change of method that lost its state
// or took another's past would show.
TEST(StepPlans, MotionGoesOnWithoutAJumpThroughChanges) {
  SimulatedCloth changing = plannedSimulation();
  SimulatedCloth staying = plannedSimulation({severalPlans()[1]});
  for (SimulatedCloth* simulation : {&changing, &staying}) {
    simulation->move({20, 21, 22, 23, 24}, {0.05, 0.0, 0.0}, 0.2);
  }
  for (int i = 0; i < 60; ++i) {
    const cloth::ClothState before = changing.state();
    changing.use(static_cast<std::size_t>(i / 2) % severalPlans().size());
    runSteps(changing, 1);
    runSteps(staying, 1);
    for (std::size_t p = 0; p < before.positions.size(); ++p) {
      const Eigen::Vector3d way = changing.state().positions[p] - before.positions[p];
      const Eigen::Vector3d mean =
          0.5 * (changing.state().velocities[p] + before.velocities[p]) * changing.timeStep();
      EXPECT_LT((way - mean).norm(), 1.5e-3) << "particle " << p << " in step " << i;
      EXPECT_LT((changing.state().positions[p] - staying.state().positions[p]).norm(), 0.01);
    }
  }
}

TEST(StepPlans, ClothAtRestStaysAtRestThroughChanges) {
  SimulatedCloth simulation = plannedSimulation();
  runSteps(simulation, 1000);  // 5 s
  ASSERT_LT(fastest(simulation.state()), 1e-6);
  const cloth::ClothState rest = simulation.state();
  const std::uint64_t computed = simulation.computedSteps();
  for (int change = 0; change < 20; ++change) {
    simulation.use((3 * change + 1) % severalPlans().size());
    simulation.setFabric(simulation.cloth().fabric());  // or it would sleep, whatever the plan
    runSteps(simulation, 2);
  }
  EXPECT_EQ(simulation.computedSteps(), computed + 40);
  EXPECT_LT(fastest(simulation.state()), 1e-5);
  for (std::size_t i = 0; i < rest.positions.size(); ++i) {
    EXPECT_LT((simulation.state().positions[i] - rest.positions[i]).norm(), 1e-7);
  }
}

// The cloth leaves what double numbers hold in the second substep.
TEST(StepPlans, ARejectedSubstepTakesBackTheWholeStep) {
  cloth::StepSettings explicit_step;
  explicit_step.method = cloth::IntegrationMethod::kExplicitEuler;
  SimulatedCloth simulation = plannedSimulation({{explicit_step, 4}});
  runSteps(simulation, 2);
  material::Fabric fabric = simulation.cloth().fabric();
  // So stiff that one substep stretches it beyond bounds, and the forces of the next overflow.
  fabric.weft.elastic = fabric.warp.elastic = material::StrainStressCurve::linear(1e160);
  simulation.setFabric(fabric);
  const cloth::ClothState before = simulation.state();
  const cloth::Cloth& cloth = simulation.cloth();
  cloth::ClothState state = before;
  cloth::Integrator integrator(cloth, explicit_step);
  ASSERT_TRUE(integrator.step(cloth, state, 0.25 * simulation.timeStep()).accepted);
  EXPECT_FALSE(simulation.step());
  EXPECT_TRUE(simulation.lastStepRejected());
  EXPECT_EQ(simulation.steps(), 2u);
  expectSame(simulation.state(), before);
}

TEST(StepPlans, StayThroughResetAndChangesOfTheFabric) {
  SimulatedCloth simulation = plannedSimulation(severalPlans(), true);
  simulation.use(2);
  runSteps(simulation, 5);
  const cloth::ClothState after_five = simulation.state();
  material::Fabric other = simulation.cloth().fabric();
  const material::Fabric first = other;
  other.bending_hysteresis->warp = other.bending->warp = 0.0;  // another pattern
  simulation.setFabric(other);
  for (std::size_t plan = 0; plan < severalPlans().size(); ++plan) {
    simulation.use(plan);
    runSteps(simulation, 2);
  }
  simulation.setFabric(first);
  simulation.reset();
  simulation.use(2);
  runSteps(simulation, 5);
  expectSame(simulation.state(), after_five);
}

TEST(StepPlans, FollowTheController) {
  SimulatedCloth simulation = plannedSimulation();
  EXPECT_THROW(simulation.setController(QualityController({1e-3}, 1.0, 1.0, 0)),
               std::invalid_argument);
  // Budgets that every step misses, and that none does.
  simulation.setController(QualityController({1, 2, 3, 4}, 1e-9, 0.005, 3));
  EXPECT_EQ(simulation.plan(), 3u);
  runSteps(simulation, 4);
  EXPECT_EQ(simulation.plan(), 0u);
  simulation.setController(QualityController({1, 2, 3, 4}, 1e9, 0.005, 0));
  runSteps(simulation, 1 + static_cast<int>(3 * QualityController::kHold / 0.005) + 3);
  EXPECT_EQ(simulation.plan(), 3u);
  EXPECT_EQ(simulation.controller()->times().cycles, 200u);
}

TEST(StepPlans, RefusesPlansThatThereCannotBe) {
  EXPECT_THROW(plannedSimulation({}), std::invalid_argument);
  EXPECT_THROW(plannedSimulation({{cloth::StepSettings(), 0}}), std::invalid_argument);
  cloth::StepSettings intolerant;
  intolerant.tolerance = 0.0;
  EXPECT_THROW(plannedSimulation({{intolerant, 1}}), std::invalid_argument);
  SimulatedCloth simulation = plannedSimulation();
  EXPECT_THROW(simulation.use(4), std::invalid_argument);
  EXPECT_EQ(simulation.plan(), 0u);
}

TEST(StepPlans, InRealTimeSeveralStepsOfTheSceneAreTakenAtOnce) {
  cloth::StepSettings step;
  SimulatedCloth at_once = plannedSimulation({{step, 1, 2}});
  scene::Scene scene = smallScene();
  scene.time_step *= 2.0;
  SimulatedCloth of_twice(std::move(scene), smallFabric());
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(at_once.stepInRealTime(0.0));
    ASSERT_TRUE(of_twice.step());
  }
  EXPECT_EQ(at_once.lastStepDuration(), 2.0 * at_once.timeStep());
  EXPECT_EQ(at_once.state().time, of_twice.state().time);
  EXPECT_EQ(at_once.state().positions, of_twice.state().positions);
  EXPECT_EQ(at_once.steps(), 20u);
}

TEST(StepPlans, AStepThatIsAskedForIsOneOfTheScene) {
  SimulatedCloth at_once = plannedSimulation({{cloth::StepSettings(), 1, 2}});
  SimulatedCloth one_by_one = plannedSimulation({{cloth::StepSettings(), 1, 1}});
  ASSERT_TRUE(at_once.step());
  ASSERT_TRUE(one_by_one.step());
  EXPECT_EQ(at_once.state().positions, one_by_one.state().positions);
  EXPECT_EQ(at_once.lastStepDuration(), at_once.timeStep());
}

TEST(StepPlans, RefusesSeveralStepsAtOnceInSeveralSubsteps) {
  EXPECT_THROW(plannedSimulation({{cloth::StepSettings(), 2, 2}}), std::invalid_argument);
  EXPECT_THROW(plannedSimulation({{cloth::StepSettings(), 1, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::simulation::test_step_plans
