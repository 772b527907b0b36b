// States that are set from outside, and starts from saved ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/contact/obstacles/obstacles.h"
#include "haptex/material/fabric_file.h"
#include "haptex/proximity/intersections.h"
#include "step_plans.h"

namespace haptex::simulation::test_set_state {
namespace {

using Eigen::Vector3d;
using Particles = std::vector<std::uint32_t>;
using Vectors = std::vector<Vector3d>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(SetState, ChangesWhatItNamesAndNothingElse) {
  SimulatedCloth simulation = smallSimulation();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(simulation.step());
  cloth::ClothState expected = simulation.state();
  expected.positions[4] = {0.01, 0.1, -0.2};
  expected.positions[0] = {0.02, -0.1, -0.2};
  simulation.setState({4, 0}, {expected.positions[4], expected.positions[0]}, {});
  EXPECT_EQ(simulation.state().positions, expected.positions);
  EXPECT_EQ(simulation.state().velocities, expected.velocities);
  expected.velocities[7] = {1.0, 2.0, 3.0};
  simulation.setState({7}, {}, {expected.velocities[7]});
  EXPECT_EQ(simulation.state().positions, expected.positions);
  EXPECT_EQ(simulation.state().velocities, expected.velocities);
  EXPECT_EQ(simulation.state().time, expected.time);
  EXPECT_EQ(simulation.steps(), 3u);
}

// By every method, those that remember earlier states included, and with friction that remembers
// how the cloth was bent.
TEST(SetState, GoesOnBitByBitAsASimulationThatStartsThere) {
  for (std::size_t plan = 0; plan < severalPlans().size(); ++plan) {
    SimulatedCloth simulation = plannedSimulation({severalPlans()[plan]}, true);
    SimulatedCloth other = plannedSimulation({severalPlans()[plan]}, true);
    other.setExternalForce(2, {0.05, 0.02, 0.0});
    for (int i = 0; i < 7; ++i) ASSERT_TRUE(other.step());
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(simulation.step());
    const cloth::ClothState state = other.state();
    simulation.setState({}, state.positions, state.velocities);

    scene::Scene scene = smallScene();
    scene.effects.bending = scene.effects.bending_hysteresis = true;
    scene.mesh.initial_positions = state.positions;
    scene.start_velocities = state.velocities;
    scene.start_time = simulation.state().time;
    SimulatedCloth started(scene, smallFabric(), {severalPlans()[plan]});
    EXPECT_EQ(started.state().time, simulation.state().time);
    EXPECT_EQ(started.state().velocities, state.velocities);
    for (int i = 0; i < 5; ++i) {
      ASSERT_TRUE(simulation.step());
      ASSERT_TRUE(started.step());
      EXPECT_EQ(simulation.state().positions, started.state().positions) << plan << " " << i;
      EXPECT_EQ(simulation.state().velocities, started.state().velocities) << plan << " " << i;
    }
    started.reset();  // leads back to the saved state
    EXPECT_EQ(started.state().positions, state.positions);
    EXPECT_EQ(started.state().velocities, state.velocities);
    EXPECT_EQ(started.state().time, scene.start_time);
  }
}

TEST(SetState, KeepsAttachedParticlesInTheirPlaces) {
  SimulatedCloth simulation = smallSimulation();
  simulation.move({kSmallTop}, {0.05, 0.0, 0.0}, 10 * simulation.timeStep());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(simulation.step());
  const cloth::ClothState on_its_way = simulation.state();
  simulation.setState({}, on_its_way.positions, on_its_way.velocities);
  simulation.setState({kSmallTop}, {on_its_way.positions[kSmallTop] + Vector3d(0.0, 0.9e-9, 0.0)},
                      {});
  EXPECT_EQ(simulation.state().positions, on_its_way.positions);
  const auto refusal = [&](const Vectors& positions, const Vectors& velocities) -> std::string {
    return test::refusalOf([&] { simulation.setState({0, kSmallTop}, positions, velocities); });
  };
  EXPECT_NE(refusal({Vector3d::Zero(), Vector3d(0.0, -0.1, 1.0)}, {})
                .find("particle 20 is attached: allowed is its place (0.0"),
            std::string::npos);
  EXPECT_NE(refusal({}, {Vector3d::Zero(), Vector3d(0.0, 9.0, 0.0)})
                .find("particle 20 is attached: allowed is its velocity ("),
            std::string::npos);
  EXPECT_EQ(simulation.state().positions, on_its_way.positions);
  simulation.release({kSmallTop});
  EXPECT_EQ(refusal({Vector3d::Zero(), Vector3d(0.0, -0.1, 1.0)}, {}), test::kNotRefused);
  EXPECT_EQ(simulation.state().positions[kSmallTop], Vector3d(0.0, -0.1, 1.0));
}

TEST(SetState, RefusesWhatIsWrongAndGoesOn) {
  const auto expect_refused = [](const Particles& particles, const Vectors& positions,
                                 const Vectors& velocities, const std::string& expected) {
    SimulatedCloth simulation = smallSimulation();
    SimulatedCloth untouched = smallSimulation();
    try {
      simulation.setState(particles, positions, velocities);
      FAIL() << "accepted, instead of: " << expected;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(simulation.step() && untouched.step());
    EXPECT_EQ(simulation.state().positions, untouched.state().positions);
  };
  const Vectors two(2, Vector3d::Zero());
  expect_refused({0, 1}, {}, {}, "positions and velocities are empty: allowed is one of them");
  expect_refused({0, 25}, two, {}, "particles[1] = 25 does not exist: allowed are 0 to 24");
  expect_refused({1, 1}, two, {}, "particles[1] = 1 is named twice");
  expect_refused({0}, two, {}, "positions has 2 elements and particles 1: allowed is one for each");
  expect_refused({}, two, {}, "positions has 2 elements and particles 25");
  expect_refused({0, 1}, two, Vectors(3, Vector3d::Zero()), "velocities has 3 elements");
  for (const double number : {kNaN, kInfinity, -kInfinity, 1.1e9}) {
    const Vectors spoiled = {Vector3d::Zero(), Vector3d(0.0, number, 0.0)};
    expect_refused({0, 1}, spoiled, {}, "positions[1] = (0, ");
    expect_refused({0, 1}, two, spoiled, "velocities[1] = (0, ");
  }
  expect_refused({0}, {{2e9, 0, 0}}, {}, "allowed are finite components from -1000000000 to");
}

TEST(SetState, WakesACloth) {
  scene::Scene scene = smallScene();
  scene.effects.gravity.setZero();  // at rest from the start
  SimulatedCloth simulation(scene, smallFabric());
  for (int i = 0; i < 1000 && !simulation.asleep(); ++i) ASSERT_TRUE(simulation.step());
  ASSERT_TRUE(simulation.asleep());
  simulation.setState({0}, {}, {{0.1, 0.0, 0.0}});
  EXPECT_FALSE(simulation.asleep());
  ASSERT_TRUE(simulation.step());
  EXPECT_GT(simulation.state().positions[0].x(), 1e-4);
}

/// Folded to half of its height, with a corner through the other layer.
TEST(SetState, ThatIntersectsItselfIsPulledApart) {
  scene::Scene scene = smallScene();
  scene.effects.gravity.setZero();
  scene.effects.bending = scene.effects.self_collision = true;
  const std::vector<std::array<int, 3>> triangles = scene.mesh.triangles;
  SimulatedCloth simulation(scene,
                            material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(simulation.step());
  Vectors positions = simulation.state().positions;
  for (int i = 0; i < 10; ++i) {
    positions[i].z() = -0.2 - positions[i].z();
    positions[i].x() = 0.01;
  }
  positions[0] += Vector3d(-0.02, 0.01, 0.01);
  simulation.setState({}, positions, {});
  EXPECT_FALSE(proximity::intersectingTriangles(positions, triangles).empty());
  int steps = 0;
  for (; steps < 400; ++steps) {
    ASSERT_TRUE(simulation.step()) << steps;
    if (simulation.lastReport().tangle.pairs == 0) break;
  }
  EXPECT_LT(steps, 400);
  EXPECT_TRUE(proximity::intersectingTriangles(simulation.state().positions, triangles).empty());
}

TEST(SetState, InASolidObstacleIsOutsideAfterAStep) {
  scene::Scene scene = smallScene();
  scene.effects.contacts = true;
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.02}, Eigen::Isometry3d::Identity()};
  ball.pose.translation() = Vector3d(0.05, 0.0, -0.3);
  ball.friction = 0.3;
  scene.obstacles = {ball};
  SimulatedCloth simulation(scene, smallFabric());
  ASSERT_TRUE(simulation.step());
  simulation.setState({0}, {{0.045, 0.0, -0.31}}, {Vector3d::Zero()});
  ASSERT_TRUE(simulation.step());
  const double distance =
      contact::makeObstacle(ball).distance(simulation.state().positions[0]).distance;
  EXPECT_GE(distance, contact::ObstacleCollision::kOffset - contact::ObstacleCollision::kTolerance);
}

/// It is caught there, also where its steps are not finite, until it is set outside.
TEST(SetState, InAnObstacleOfAClothThatCollidesWithItselfIsNotForEver) {
  scene::Scene scene = smallScene();
  scene.effects.bending = scene.effects.contacts = scene.effects.self_collision = true;
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.02}, Eigen::Isometry3d::Identity()};
  ball.pose.translation() = Vector3d(0.05, 0.0, -0.1);
  scene.obstacles = {ball};
  SimulatedCloth simulation(scene,
                            material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml"));
  ASSERT_TRUE(simulation.step());
  const proximity::RigidObstacle shape = contact::makeObstacle(ball);
  for (const double x : {0.04, 0.05}) {
    const Vector3d outside = simulation.state().positions[12];
    simulation.setState({12}, {{x, 0.0, -0.1}}, {});
    for (int i = 0; i < 5; ++i) simulation.step();
    EXPECT_LT(shape.distance(simulation.state().positions[12]).distance, 0.0);
    simulation.setState({12}, {outside}, {Vector3d::Zero()});
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(simulation.step()) << x;
    EXPECT_EQ(contact::firstTouching(scene.mesh.triangles, simulation.state().positions, shape),
              -1);
  }
}

/// A ball that has passed through where the sheet hangs, when the state was saved.
TEST(SavedStart, MeetsObstaclesWhereTheyAreAtItsTime) {
  scene::Scene scene = smallScene();
  scene.effects.bending = scene.effects.contacts = scene.effects.self_collision = true;
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.02}, Eigen::Isometry3d::Identity()};
  ball.pose.translation() = Vector3d(0.0, 0.0, -0.1);
  ball.motion = mesh::ObstacleDrift{{0.1, 0.0, 0.0}};
  scene.obstacles = {ball};
  const material::Fabric fabric =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/wool.yaml");
  EXPECT_THROW(SimulatedCloth(scene, fabric), std::invalid_argument);
  scene.start_time = 1.0;
  SimulatedCloth simulation(scene, fabric);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(simulation.step());
  for (const Vector3d& position : simulation.state().positions) {
    EXPECT_LT(std::abs(position.x()), 1e-3);  // nothing touches it
  }
}

}  // namespace
}  // namespace haptex::simulation::test_set_state
