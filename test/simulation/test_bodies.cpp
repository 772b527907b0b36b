// Obstacles with mass in a simulated scene.
#include <gtest/gtest.h>

#include "small_scene.h"

namespace haptex::simulation::test_bodies {
namespace {

using Eigen::Vector3d;

scene::Scene sceneWithBall(const Vector3d& velocity) {
  scene::Scene scene = smallScene();
  scene.effects.contacts = true;
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.03},
                      Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, -0.1))};
  ball.friction = 0.3;
  ball.body = mesh::ObstacleBody{0.01, velocity};
  scene.obstacles = {ball};
  return scene;
}

TEST(Bodies, MoveAndStartAnewAfterAReset) {
  SimulatedCloth simulation(sceneWithBall({-1.0, 0.0, 1.0}), smallFabric());
  const auto run = [&] {
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(simulation.step());
    return simulation.bodies()[0].pose().translation();
  };
  const Vector3d once = run();
  EXPECT_GT(simulation.bodies()[0].velocity()[0], -0.9) << "the cloth did not stop it";
  EXPECT_FALSE(simulation.asleep());
  simulation.reset();
  EXPECT_EQ(simulation.bodies()[0].pose().translation(), Vector3d(0.1, 0.0, -0.1));
  EXPECT_EQ(simulation.bodies()[0].momentum(), Vector3d(-0.01, 0.0, 0.01));
  EXPECT_EQ(run(), once);
}

/// As many steps of a plan as are accepted before one is not.
int acceptedSteps(const scene::Scene& scene, const StepPlan& plan) {
  SimulatedCloth simulation(scene, smallFabric(), {plan});
  int accepted = 0;
  while (accepted < 1000 && simulation.step()) ++accepted;
  return accepted;
}

TEST(Bodies, GoBackWithASubstepThatWasRejected) {
  scene::Scene scene = sceneWithBall({-1.0, 0.0, 1.0});
  StepPlan plan;
  plan.step.method = cloth::IntegrationMethod::kExplicitEuler;
  // Far from stable, and so that the second of two substeps is the one that is rejected.
  scene.time_step = 0.02;
  while (scene.time_step < 1.0 && acceptedSteps(scene, plan) % 2 == 0) scene.time_step *= 1.1;
  ASSERT_LT(scene.time_step, 1.0);
  scene.time_step *= 2.0;
  plan.substeps = 2;
  SimulatedCloth simulation(std::move(scene), smallFabric(), {plan});
  Vector3d before = Vector3d::Zero();
  int accepted = 0;
  do {
    before = simulation.bodies()[0].pose().translation();
  } while (simulation.step() && ++accepted < 1000);
  ASSERT_TRUE(simulation.lastStepRejected());
  EXPECT_EQ(simulation.bodies()[0].pose().translation(), before);
}

TEST(Bodies, ThereAreNoneWithoutMass) {
  EXPECT_TRUE(smallSimulation().bodies().empty());
  scene::Scene scene = sceneWithBall(Vector3d::Zero());
  scene.obstacles[0].body.reset();
  EXPECT_TRUE(SimulatedCloth(std::move(scene), smallFabric()).bodies().empty());
}

TEST(Bodies, PlansThatDoNotKnowThemAreRefused) {
  StepPlan plan;
  plan.step.method = cloth::IntegrationMethod::kTrBdf2;
  EXPECT_THROW(SimulatedCloth(sceneWithBall(Vector3d::Zero()), smallFabric(), {plan}),
               std::invalid_argument);
  scene::Scene penalty = sceneWithBall(Vector3d::Zero());
  penalty.penalty = 10.0;
  EXPECT_THROW(SimulatedCloth(penalty, smallFabric(), {StepPlan{}}), std::invalid_argument);
  plan.step.method = cloth::IntegrationMethod::kRungeKutta4;
  EXPECT_NO_THROW(SimulatedCloth(penalty, smallFabric(), {plan}));
  penalty.penalty = -1.0;
  EXPECT_THROW(SimulatedCloth(penalty, smallFabric(), {plan}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::simulation::test_bodies
